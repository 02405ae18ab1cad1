cmake_minimum_required(VERSION 3.25)

# Writes SOURCE, which defines shaders (engine/gpu/shader.h) that HEADER declares in NAMESPACE. FOLDER has each one's SPIR-V as an
# array, and what `glslangValidator -q` lists of it. SHADERS: "symbol,constant,name,stage", then ",symbol" of the variant
# without doubles. Fails on whatever it does not know.

# Types of images, as OpenGL numbers them.
set(descriptor_8dc1 VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)  # sampler2DArray
set(descriptor_8dd8 VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER)    # utextureBuffer, usamplerBuffer

# Sets `bindings`, lines of C++ by number, and `push_bytes`.
function(read_listing symbol)
  set(path ${FOLDER}/${symbol}.txt)
  file(STRINGS ${path} lines)
  set(bindings "")
  set(numbers "")
  set(push_bytes 0)
  set(section "")
  foreach(line IN LISTS lines)
    set(descriptor "")
    if(line MATCHES "^(Uniform|Uniform block|Buffer variable|Buffer block|Pipeline input|Pipeline output) reflection:$")
      set(section ${CMAKE_MATCH_1})
      continue()
    elseif(line MATCHES "^(Local size [XYZ]: [0-9]+)?$" OR section MATCHES "^(Buffer variable|Pipeline input|Pipeline output)$")
      continue()
    elseif(NOT line MATCHES "^([A-Za-z0-9_.]+): offset -?[0-9]+, type ([0-9a-f]+), size ([0-9]+), index (-?[0-9]+), binding (-?[0-9]+), stages [0-9]+")
      message(FATAL_ERROR "${path}: what is \"${line}\"?")
    endif()
    set(name ${CMAKE_MATCH_1})
    set(type ${CMAKE_MATCH_2})
    set(size ${CMAKE_MATCH_3})
    set(index ${CMAKE_MATCH_4})
    set(number ${CMAKE_MATCH_5})
    if(section STREQUAL "Uniform" AND number EQUAL -1 AND NOT index EQUAL -1)
      continue()  # a push constant
    elseif(section STREQUAL "Uniform block" AND number EQUAL -1 AND push_bytes EQUAL 0)
      set(push_bytes ${size})
      continue()
    elseif(section STREQUAL "Uniform" AND size EQUAL 1)
      set(descriptor "${descriptor_${type}}")
    elseif(section STREQUAL "Buffer block")
      set(descriptor VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)
    endif()
    if(number EQUAL -1 OR descriptor STREQUAL "")
      message(FATAL_ERROR "${path}: \"${name}\" is not a storage buffer, a utextureBuffer or a sampler2DArray, with a binding")
    elseif(number IN_LIST numbers)
      message(FATAL_ERROR "${path}: two have binding ${number}, \"${name}\" is one")
    endif()
    list(APPEND numbers ${number})
    list(APPEND bindings "{${number}, ${descriptor}, \"${name}\"}")
  endforeach()
  if(NOT bindings)
    message(FATAL_ERROR "${path}: nothing is bound")
  endif()
  list(SORT bindings COMPARE NATURAL)
  set(bindings "${bindings}" PARENT_SCOPE)
  set(push_bytes ${push_bytes} PARENT_SCOPE)
endfunction()

set(includes "")
set(definitions "")
set(all "")
foreach(shader ${SHADERS})
  string(REPLACE "," ";" shader ${shader})
  list(POP_FRONT shader symbol constant name stage)
  string(APPEND includes "#include \"spirv/${symbol}.h\"\n")
  set(variant {})
  if(shader)
    read_listing(${shader})
    set(of_variant ${bindings})
    set(its_push_bytes ${push_bytes})
    set(variant k_${shader})
    string(APPEND includes "#include \"spirv/${shader}.h\"\n")
  endif()
  read_listing(${symbol})
  if(shader)
    list(REMOVE_ITEM of_variant ${bindings})
    if(of_variant OR NOT its_push_bytes EQUAL push_bytes)
      message(FATAL_ERROR "${name}: the variant without doubles binds ${of_variant}, pushes ${its_push_bytes} bytes")
    endif()
  endif()
  list(JOIN bindings ", " bindings)
  set(use contact)
  if(name MATCHES "^(sampled|arithmetic)/")
    set(use ${CMAKE_MATCH_1})
  endif()
  string(APPEND definitions "static const Binding ${constant}Bindings[] = {${bindings}};\n"
    "const Shader ${constant}{\"${name}\", Use::${use}, ${stage}, k_${symbol}, ${variant}, ${constant}Bindings, ${push_bytes}};\n")
  string(APPEND all "&${constant}, ")
endforeach()
file(WRITE ${SOURCE} "#include \"${HEADER}\"\n\n${includes}
namespace ${NAMESPACE} {\n
using radar::gpu::Binding;
using radar::gpu::Use;\n
${definitions}
static const Shader* const kEvery[] = {${all}};
const std::span<const Shader* const> kAll = kEvery;\n
}  // namespace ${NAMESPACE}\n")
