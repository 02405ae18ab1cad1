# Compiles each public header alone, and two examples, with the warnings that careful hosts treat as errors, by each of the
# compilers. What searches on the CPU alone needs no headers of Vulkan:
#   cmake "-DCOMPILERS=g++;clang++" "-DEXAMPLES=a.cpp;b.cpp" -DSOURCE=... -DVULKAN=... -DEIGEN=... -DFOLDER=... -P warnings.cmake
cmake_minimum_required(VERSION 3.25)

file(MAKE_DIRECTORY ${FOLDER})
file(GLOB headers RELATIVE ${SOURCE}/engine/include ${SOURCE}/engine/include/radar/*.h)
if(NOT headers)
  message(FATAL_ERROR "expected headers in ${SOURCE}/engine/include/radar")
endif()
set(sources ${EXAMPLES})
foreach(header ${headers})
  string(MAKE_C_IDENTIFIER ${header} name)
  file(WRITE ${FOLDER}/${name}.cpp "#include <${header}>\n")
  list(APPEND sources ${FOLDER}/${name}.cpp)
endforeach()
set(without_vulkan ${FOLDER}/without_vulkan)
file(WRITE ${without_vulkan}/vulkan/vulkan_core.h "#error the search on the CPU needs this\n")
# Whether a header needs another one does not depend on the compiler: all but the first get those at once.
set(together ${FOLDER}/all_headers.cpp)
list(TRANSFORM headers REPLACE "(.+)" "#include <\\1>" OUTPUT_VARIABLE includes)
list(JOIN includes "\n" includes)
file(WRITE ${together} "${includes}\n")
foreach(compiler ${COMPILERS})
  foreach(source ${sources})
    set(vulkan -idirafter ${VULKAN})
    if(source MATCHES "radar_(answers|codes|cpu_sweeper|eigen|error|query|scene)_h.cpp|eigen_arrays.cpp")
      set(vulkan -I${without_vulkan})
    endif()
    execute_process(
      COMMAND ${compiler} -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror
              -I${SOURCE}/engine/include ${vulkan} -isystem ${EIGEN} ${source}
      RESULT_VARIABLE status ERROR_VARIABLE errors)
    if(NOT status EQUAL 0)
      message(SEND_ERROR "${compiler} ${source}:\n${errors}")
    endif()
  endforeach()
  set(sources ${EXAMPLES} ${together})
endforeach()
