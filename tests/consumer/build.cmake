# Builds the README's example, and that of Eigen's arrays, in a separate project and runs them: cmake -DHOW=... -P build.cmake.
cmake_minimum_required(VERSION 3.25)

file(MAKE_DIRECTORY ${FOLDER})
if(HOW STREQUAL "pkg-config")
  file(GLOB_RECURSE description ${INSTALLED}/*/cyber-radar.pc)
  cmake_path(GET description PARENT_PATH folder)
  set(ENV{PKG_CONFIG_PATH} ${folder})
  execute_process(COMMAND pkg-config --static --cflags --libs "cyber-radar = ${VERSION}"
    OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  if(flags MATCHES "vulkan")
    message(FATAL_ERROR "the loader is opened at run time, but pkg-config names it: ${flags}")
  endif()
  separate_arguments(flags)
  foreach(app readme eigen_arrays)
    execute_process(COMMAND ${CXX} -std=c++20 ${SOURCE}/tests/consumer/${app}.cpp -isystem ${EIGEN} ${flags}
      -o ${FOLDER}/${app} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
else()
  # A debug build without debug information takes the least time. What a host's -ffast-math links sets the processor to
  # flush subnormals, which must not reach the engine.
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer/project -B ${FOLDER} -G Ninja -DHOW=${HOW}
    -DSOURCE=${SOURCE} -DCMAKE_PREFIX_PATH=${INSTALLED} -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS=-g0 -ffast-math"
    -DCMAKE_CXX_COMPILER=${CXX} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
endif()
function(expect_output app expected)
  execute_process(COMMAND ${FOLDER}/${app} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${app} printed \"${output}\", expected \"${expected}\"")
  endif()
endfunction()
expect_output(readme "touches object 0 after 5")
expect_output(eigen_arrays "vertices are off by at most 1.49012e-09
the points lie about 1 1 0
all move by 5.1")
