# run(ARGUMENT...) runs the program, and sets `status` and `output`, which has what it and the layers have printed.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
macro(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${FOLDER} OUTPUT_VARIABLE output ERROR_VARIABLE output
    RESULT_VARIABLE status)
endmacro()

# Fails unless the program has ended well, validation was silent, and the output matches each expression.
function(expect_quiet)
  if(NOT status EQUAL 0 OR output MATCHES "Validation|VUID|SYNC-HAZARD")
    message(FATAL_ERROR "status ${status}:\n${output}")
  endif()
  foreach(expression ${ARGN})
    if(NOT output MATCHES "${expression}")
      message(FATAL_ERROR "expected \"${expression}\" in:\n${output}")
    endif()
  endforeach()
endfunction()
