# Builds each example where it is installed, and runs it.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/pictures)

# run(program expression argument...): fails unless what program and layers print matches, and validation is silent.
function(run program expression)
  execute_process(COMMAND ${FOLDER}/${program} ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "${expression}" OR output MATCHES "Validation|VUID|SYNC-HAZARD")
    message(FATAL_ERROR "expected \"${expression}\" and no message of validation in:\n${output}")
  endif()
endfunction()

# A debug build without debug information takes the least time.
foreach(example recorder renderer)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${INSTALLED}/share/cyber-radar/examples/${example} -B ${FOLDER}/${example} -G Ninja
    -DCMAKE_PREFIX_PATH=${INSTALLED} -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS=-g0 -DCMAKE_CXX_COMPILER=${CXX}
    OUTPUT_VARIABLE configured COMMAND_ERROR_IS_FATAL ANY)
  if(configured MATCHES "radar-example-renderer is not built: [^\n]*")
    message("skipped: ${CMAKE_MATCH_0}")
    return()
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${FOLDER}/${example} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
run(recorder/radar-example-recorder "none touches anything\n")
run(renderer/radar-example-renderer "checks by the CPU: 1, crossings: 0\n" 40 50 ${FOLDER}/pictures)
