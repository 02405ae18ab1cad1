cmake_minimum_required(VERSION 3.25)

# shaders/describe.cmake refuses shaders that bind what kernels cannot: cmake -DGLSLANG=... -DDESCRIBE=... -DFOLDER=... -P this.
file(MAKE_DIRECTORY ${FOLDER})

# Declares something in a shader that also has a storage buffer, and reads it by an expression.
function(describe name declaration expression)
  file(WRITE ${FOLDER}/${name}.comp "#version 460
layout(local_size_x = 1) in;
layout(binding = 0) buffer Words { float words[]; };
${declaration}
void main() { words[0] = ${expression}; }
")
  execute_process(COMMAND ${GLSLANG} --quiet -V --target-env vulkan1.3 -l -q --reflect-separate-buffers -o ${FOLDER}/${name}.spv
    ${FOLDER}/${name}.comp OUTPUT_FILE ${FOLDER}/${name}.txt COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} -DSHADERS=${name},kTried,tried,VK_SHADER_STAGE_COMPUTE_BIT -DFOLDER=${FOLDER}
    -DNAMESPACE=tried -DHEADER=tried.h -DSOURCE=${FOLDER}/${name}.cpp -P ${DESCRIBE} RESULT_VARIABLE failed ERROR_VARIABLE message)
  string(REGEX REPLACE "[ \n]+" " " message "${message}")
  set(failed "${failed}" PARENT_SCOPE)
  set(message "${message}" PARENT_SCOPE)
endfunction()

function(refuses name declaration expression words)
  describe(${name} "${declaration}" "${expression}")
  if(NOT failed OR NOT message MATCHES "${words}")
    message(FATAL_ERROR "${name}: expected a refusal with \"${words}\", got ${failed}: ${message}")
  endif()
endfunction()

describe(accepted "layout(push_constant) uniform Push { float x; uint n; } push;" push.x)
file(STRINGS ${FOLDER}/accepted.cpp found REGEX "\"Words\"|k_accepted, {}, kTriedBindings, 8}")
list(LENGTH found lines)
if(failed OR NOT lines EQUAL 2)
  message(FATAL_ERROR "a storage buffer and push constants were refused or lost: ${message}")
endif()
refuses(uniform_buffer "layout(binding = 1) uniform Block { float x; } block;" block.x "\"Block\" is not a storage buffer")
refuses(image "layout(binding = 1, r32f) uniform image2D picture;" "imageLoad(picture, ivec2(0)).x" "\"picture\" is not")
refuses(other_sampler "layout(binding = 1) uniform sampler2D picture;" "texelFetch(picture, ivec2(0), 0).x" "\"picture\" is not")
refuses(array "layout(binding = 1) uniform sampler2DArray pictures[2];" "texelFetch(pictures[1], ivec3(0), 0).x" "pictures")
refuses(same_binding "layout(binding = 0) buffer More { float more[]; };" "more[0]" "two have binding 0")
