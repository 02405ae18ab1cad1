include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

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
run(${FOLDER}/recorder/radar-example-recorder)
expect_quiet("none touches anything\n")
run(${FOLDER}/renderer/radar-example-renderer --headless --agents 40 --frames 50 --size 64x64 --out pictures)
expect_quiet("checks by the CPU: 1, crossings: 0\n")
