// The paper's scopes of a query of mode sampled: R, M and L as pictures.

import { viridis } from "./colours.js";
import { made } from "./elements.js";
import { plus, times } from "./vectors.js";
import { inDigits } from "./words.js";

/** The window's outline, as placed at the sensor's back plane, and from there to the end of the target volume. */
export function frameOf({ width, height, pixel, d, origin, right, up, forward }) {
  const corner = (x, y, z) =>
    plus(plus(plus(origin, times(x * width * pixel, right)), times(y * height * pixel, up)), times(z * d, forward));
  const ring = [[0, 0], [1, 0], [1, 1], [0, 1]], lines = [];
  ring.forEach(([x, y], i) => {
    const [u, v] = ring[(i + 1) % 4];
    lines.push([corner(x, y, 0), corner(u, v, 0)], [corner(x, y, 1), corner(u, v, 1)], [corner(x, y, 0), corner(x, y, 1)]);
  });
  return lines;
}

const SCOPES = {
  R: "from the sensor's back plane to the scene", M: "from the far end of the volume back to the sensor",
  L: "R + M − d, the free distance",
};

/** A picture of one scope into `place`; pixels without a value are hatched, the least of L has a ring. */
function drawScope(place, name, scopes) {
  const { width, height } = scopes, values = scopes[name];
  const figure = made(place, "figure"), canvas = made(figure, "canvas");
  figure.onclick = () => figure.classList.toggle("large");
  let lo = Infinity, hi = -Infinity, least = -1;
  values.forEach((value, i) => {
    if (!Number.isFinite(value)) return;
    if (value < lo) [lo, least] = [value, i];
    hi = Math.max(hi, value);
  });
  const factor = Math.max(1, Math.floor(480 / Math.max(width, height)));
  Object.assign(canvas, { width: factor * width, height: factor * height });
  const context = canvas.getContext("2d");
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const value = values[y * width + x];  // rows from below
      const shade = (x + y) % 2 ? 0.93 : 0.85;
      const colour = Number.isFinite(value) ? viridis((value - lo) / (hi - lo || 1)) : [shade, shade, shade];
      context.fillStyle = `rgb(${colour.map((c) => Math.round(255 * c)).join()})`;
      context.fillRect(factor * x, factor * (height - 1 - y), factor, factor);
    }
  }
  if (name === "L" && least >= 0) {
    context.lineWidth = 4;
    for (const { style, radius } of [{ style: "#fff", radius: 18 }, { style: "#d00", radius: 22 }]) {
      context.strokeStyle = style;
      context.beginPath();
      const x = (least % width) + 0.5, y = height - Math.floor(least / width) - 0.5;
      context.arc(factor * x, factor * y, radius, 0, 2 * Math.PI);
      context.stroke();
    }
  }
  const range = lo <= hi ? `${inDigits(lo)} to ${inDigits(hi)}` : "no value";
  const scale = made(figure, "div", "scale");
  scale.style.background = `linear-gradient(90deg,${[0, 0.25, 0.5, 0.75, 1].map((share) =>
    `rgb(${viridis(share).map((c) => Math.round(255 * c)).join()})`).join()})`;
  made(figure, "figcaption", "", `${name}: ${SCOPES[name]}; ${range}`);
  const under = made(figure, "figcaption", "under", "point at a pixel");
  canvas.onmousemove = ({ offsetX, offsetY }) => {
    const x = Math.floor((offsetX / canvas.clientWidth) * width);
    const y = height - 1 - Math.floor((offsetY / canvas.clientHeight) * height);
    const value = values[y * width + x];
    under.textContent = `pixel ${x}, ${y}: ${Number.isFinite(value) ? inDigits(value) : "no value"}`;
  };
}

export function drawScopes(place, scopes) {
  made(place, "p", "", `${scopes.width} × ${scopes.height} pixels of ${inDigits(scopes.pixel)}; d = ${inDigits(scopes.d)}, ` +
    `the sensor is ${inDigits(scopes.length)} long`);
  const row = made(place, "div", "scopes");
  for (const name of Object.keys(SCOPES)) drawScope(row, name, scopes);
}
