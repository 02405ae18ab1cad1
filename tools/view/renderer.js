// Draws placed meshes, lines and marks with WebGL 2. Places are relative to the eye, so that scenes far from the origin
// are as sharp as others.

const SURFACE_SHADERS = [`#version 300 es
in vec3 position; in vec4 row0, row1, row2; in vec4 colour; in uint id;
uniform mat4 clipFromEye;
out vec3 place; flat out vec4 tint; flat out uint number;
void main() {
  vec4 p = vec4(position, 1);
  place = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  tint = colour;
  number = id;
  gl_Position = clipFromEye * vec4(place, 1);
}`, `#version 300 es
precision highp float; precision highp int;
in vec3 place; flat in vec4 tint; flat in uint number;
uniform int kind; uniform vec3 up;
out vec4 result;
void main() {
  if (kind == PICK) {
    result = vec4((uvec4(number) >> uvec4(0, 8, 16, 24)) & 255u) / 255.0;
    return;
  }
  vec3 normal = cross(dFdx(place), dFdy(place)), view = normalize(place);
  normal = dot(normal, normal) > 0.0 ? normalize(normal) : -view;
  if (dot(normal, view) > 0.0) normal = -normal;
  if (kind == GHOST) {  // like glass: its rim shows
    float rim = 1.0 + dot(normal, view);
    result = vec4(tint.rgb, tint.a * (0.15 + 0.7 * rim * rim));
    return;
  }
  float light = 0.62 + 0.22 * dot(normal, up) - 0.3 * dot(normal, view);
  result = vec4(tint.rgb * light, 1);
}`];

const SEGMENT_SHADERS = [`#version 300 es
in vec2 corner; in vec3 from, to; in vec4 colour; in vec2 style;
uniform mat4 clipFromEye; uniform vec2 size; uniform float near;
out vec4 tint; out float along; flat out float dash;
void main() {
  vec4 a = clipFromEye * vec4(from, 1), b = clipFromEye * vec4(to, 1);
  if (a.w < near) a = mix(a, b, clamp((near - a.w) / (b.w - a.w), 0.0, 1.0));
  if (b.w < near) b = mix(b, a, clamp((near - b.w) / (a.w - b.w), 0.0, 1.0));
  vec2 way = (b.xy / b.w - a.xy / a.w) * 0.5 * size;
  vec2 unit = length(way) > 0.0 ? normalize(way) : vec2(1, 0);
  vec4 end = corner.x < 0.5 ? a : b;
  end.xy += vec2(-unit.y, unit.x) * corner.y * style.x / size * end.w;
  end.z -= 0.0004 * end.w;  // in front of the surface on which it lies
  gl_Position = end;
  tint = colour;
  along = corner.x * length(way);
  dash = style.y;
}`, `#version 300 es
precision highp float;
in vec4 tint; in float along; flat in float dash;
out vec4 result;
void main() {
  if (dash > 0.0 && mod(along, 2.0 * dash) > dash) discard;
  result = tint;
}`];

const POINT_SHADERS = [`#version 300 es
in vec3 place; in float diameter; in vec4 colour; in uint id; in float shape;
uniform mat4 clipFromEye;
flat out vec4 tint; flat out uint number; flat out float form;
void main() {
  gl_Position = clipFromEye * vec4(place, 1);
  if (shape > 0.0) gl_Position.z -= 0.001 * gl_Position.w;
  gl_PointSize = diameter;
  tint = colour;
  number = id;
  form = shape;
}`, `#version 300 es
precision highp float; precision highp int;
flat in vec4 tint; flat in uint number; flat in float form;
uniform int kind;
out vec4 result;
void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  float r = length(p), arm = min(abs(p.x - p.y), abs(p.x + p.y));
  if (form == 1.0 && r > 1.0) discard;                             // a disc
  if (form == 2.0 && (r > 1.0 || r < 0.6)) discard;                // a ring
  if (form == 3.0 && (r > 1.0 || arm > 0.4)) discard;              // a cross
  if (form == 4.0 && abs(p.x) + abs(p.y) > 1.0) discard;           // a diamond
  result = kind == PICK ? vec4((uvec4(number) >> uvec4(0, 8, 16, 24)) & 255u) / 255.0 : tint;
}`];

export const SHAPES = { square: 0, disc: 1, ring: 2, cross: 3, diamond: 4 };
const KINDS = { solid: 0, ghost: 1, pick: 2 };
export const SURFACE_WORDS = 14, SEGMENT_WORDS = 9, POINT_WORDS = 7;

export const packed = ([r, g, b, a = 1]) =>
  ((255 * r) | 0) | (((255 * g) | 0) << 8) | (((255 * b) | 0) << 16) | (((255 * a) | 0) << 24);

/** Rows of a number of words each, floats or whole. */
export class Rows {
  /** @param {number} words */
  constructor(words) {
    this.words = words;
    this.count = 0;
    this.floats = new Float32Array(64 * words);
    this.whole = new Uint32Array(this.floats.buffer);
  }
  /** The first word of a new row. */
  add() {
    const first = this.words * this.count++;
    if (first === this.floats.length) {
      const { floats } = this;
      this.floats = new Float32Array(2 * floats.length);
      this.floats.set(floats);
      this.whole = new Uint32Array(this.floats.buffer);
    }
    return first;
  }
}

/** Whether a processor draws, which smooth edges would slow down to half. */
function isSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const isSoft = gl !== null && /swiftshader|llvmpipe|software/i.test(gl.getParameter(gl.RENDERER));
  // A browser keeps only some contexts, and this one until its canvas is collected.
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return isSoft;
}

export class Renderer {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: !isSoftware(), alpha: false });
    if (!gl) throw new Error("This page needs WebGL 2, which this browser does not offer.");
    this.canvas = canvas;
    this.gl = gl;
    /** @type {?ReturnType<import("./stage.js").Stage["view"]>} */
    this.view = null;
    this.picking = false;
    this.create();
  }
  /** Makes what the context holds, also after it was lost. */
  create() {
    const { gl } = this;
    /** @type {Map<import("./meshes.js").Mesh, {positions: WebGLBuffer, indices: WebGLBuffer}>} */
    this.meshBuffers = new Map();
    this.surface = this.program(SURFACE_SHADERS);
    this.segment = this.program(SEGMENT_SHADERS);
    this.point = this.program(POINT_SHADERS);
    this.rows = gl.createBuffer();
    this.corners = this.buffer(gl.ARRAY_BUFFER, new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]));
    this.picture = gl.createFramebuffer();
    this.pictureParts = [gl.createRenderbuffer(), gl.createRenderbuffer()];
  }

  program(shaders) {
    const { gl } = this, program = gl.createProgram();
    shaders.forEach((text, i) => {
      const shader = gl.createShader(i === 0 ? gl.VERTEX_SHADER : gl.FRAGMENT_SHADER);
      gl.shaderSource(shader, text.replaceAll("GHOST", `${KINDS.ghost}`).replaceAll("PICK", `${KINDS.pick}`));
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new Error(shaders.map((_, i) => gl.getShaderInfoLog(gl.getAttachedShaders(program)[i])).join("\n"));
    }
    const names = { attributes: {}, uniforms: {} };
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_ATTRIBUTES); ++i) {
      const { name } = gl.getActiveAttrib(program, i);
      names.attributes[name] = gl.getAttribLocation(program, name);
    }
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
      const { name } = gl.getActiveUniform(program, i);
      names.uniforms[name] = gl.getUniformLocation(program, name);
    }
    return { program, ...names };
  }

  buffer(target, data) {
    const { gl } = this, made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return made;
  }

  /** Begins a picture. `view`: clipFromEye, near, up. `picking`: of numbers, to be read by numberAt. */
  begin(view, picking = false) {
    const { gl, canvas } = this, { width, height } = canvas;
    Object.assign(this, { view, picking });
    gl.bindVertexArray(null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, picking ? this.picture : null);
    if (picking) this.sizePicture(width, height);
    gl.viewport(0, 0, width, height);
    if (picking) gl.clearColor(0, 0, 0, 0);
    else gl.clearColor(0.97, 0.975, 0.98, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
  }

  sizePicture(width, height) {
    const { gl } = this, formats = [gl.RGBA8, gl.DEPTH_COMPONENT24];
    const places = [gl.COLOR_ATTACHMENT0, gl.DEPTH_ATTACHMENT];
    this.pictureParts.forEach((part, i) => {
      gl.bindRenderbuffer(gl.RENDERBUFFER, part);
      gl.renderbufferStorage(gl.RENDERBUFFER, formats[i], width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, places[i], gl.RENDERBUFFER, part);
    });
  }

  /** The number drawn at a pixel of the canvas, from its upper left corner. */
  numberAt(x, y) {
    const { gl } = this, colour = new Uint8Array(4);
    gl.readPixels(x, this.canvas.height - 1 - y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, colour);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return new Uint32Array(colour.buffer)[0];
  }

  use(kind, uniforms = {}) {
    const { gl, view } = this, at = kind.uniforms;
    gl.useProgram(kind.program);
    gl.uniformMatrix4fv(at.clipFromEye, false, view.clipFromEye);
    for (const [name, value] of Object.entries(uniforms)) {
      if (Array.isArray(value)) gl[`uniform${value.length}f`](at[name], ...value);
      else gl.uniform1i(at[name], value);
    }
  }

  upload(rows) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.rows);
    gl.bufferData(gl.ARRAY_BUFFER, rows.floats.subarray(0, rows.count * rows.words), gl.DYNAMIC_DRAW);
  }

  /** Binds the bound buffer's words of rows: {name: [first word, type, number]}, each for one instance or vertex. */
  attributes({ attributes }, words, layout, first, divisor) {
    const { gl } = this;
    for (const [name, [word, type, number]] of Object.entries(layout)) {
      const place = attributes[name], offset = 4 * (words * first + word);
      gl.enableVertexAttribArray(place);
      if (type === "whole") gl.vertexAttribIPointer(place, 1, gl.UNSIGNED_INT, 4 * words, offset);
      else if (type === "colour") gl.vertexAttribPointer(place, 4, gl.UNSIGNED_BYTE, true, 4 * words, offset);
      else gl.vertexAttribPointer(place, number, gl.FLOAT, false, 4 * words, offset);
      gl.vertexAttribDivisor(place, divisor);
    }
  }

  /** `groups`: from each Mesh to Rows of its instances. */
  surfaces(groups, kind = "solid") {
    const { gl } = this;
    if (kind === "ghost") {
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
      gl.depthMask(false);
    }
    this.use(this.surface, { kind: this.picking ? KINDS.pick : KINDS[kind], up: this.view.up });
    const layout = { row0: [0, "float", 4], row1: [4, "float", 4], row2: [8, "float", 4] };
    for (const [mesh, rows] of groups) {
      const { positions, indices } = this.buffersOf(mesh);
      gl.bindBuffer(gl.ARRAY_BUFFER, positions);
      this.attributes(this.surface, 3, { position: [0, "float", 3] }, 0, 0);
      this.upload(rows);
      this.attributes(this.surface, SURFACE_WORDS, { ...layout, colour: [12, "colour"], id: [13, "whole"] }, 0, 1);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
      gl.drawElementsInstanced(gl.TRIANGLES, mesh.indices.length, gl.UNSIGNED_INT, 0, rows.count);
    }
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  buffersOf(mesh) {
    const { gl } = this;
    if (!this.meshBuffers.has(mesh)) {
      const positions = this.buffer(gl.ARRAY_BUFFER, mesh.positions);
      this.meshBuffers.set(mesh, { positions, indices: this.buffer(gl.ELEMENT_ARRAY_BUFFER, mesh.indices) });
    }
    return this.meshBuffers.get(mesh);
  }

  /** Frees what belongs to other meshes. */
  keepOnly(/** @type {import("./meshes.js").Mesh[]} */ meshes) {
    const kept = new Set(meshes);
    for (const [mesh, { positions, indices }] of this.meshBuffers) {
      if (kept.has(mesh)) continue;
      this.gl.deleteBuffer(positions);
      this.gl.deleteBuffer(indices);
      this.meshBuffers.delete(mesh);
    }
  }

  segments(rows) {
    const { gl, canvas } = this;
    if (rows.count === 0 || this.picking) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.use(this.segment, { size: [canvas.width, canvas.height], near: [this.view.near] });
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    this.attributes(this.segment, 2, { corner: [0, "float", 2] }, 0, 0);
    this.upload(rows);
    const layout = { from: [0, "float", 3], to: [3, "float", 3], colour: [6, "colour"], style: [7, "float", 2] };
    this.attributes(this.segment, SEGMENT_WORDS, layout, 0, 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, rows.count);
    gl.disable(gl.BLEND);
  }

  points(rows) {
    const { gl } = this;
    if (rows.count === 0) return;
    this.use(this.point, { kind: this.picking ? KINDS.pick : KINDS.solid });
    this.upload(rows);
    const layout = { place: [0, "float", 3], diameter: [3, "float", 1], colour: [4, "colour"], id: [5, "whole"] };
    this.attributes(this.point, POINT_WORDS, { ...layout, shape: [6, "float", 1] }, 0, 0);
    gl.drawArrays(gl.POINTS, 0, rows.count);
  }
}
