# cmake -DFROM=(folder) -DTO=(file) -P ask.cmake; the file is written only where it changes.
execute_process(COMMAND git describe --always --dirty
  WORKING_DIRECTORY ${FROM} OUTPUT_VARIABLE commit RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(failed)
  set(commit unknown)
endif()
configure_file(${FROM}/commit.cpp.in ${TO} @ONLY)
