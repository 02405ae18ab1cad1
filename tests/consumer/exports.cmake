# A shared library exports its interface and nothing else: cmake -DLIBRARY=... -DNM=... -P exports.cmake.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${NM} -DC --defined-only ${LIBRARY} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]* [A-Za-z] radar::(gpu|exact|cpu|tools)::[^\n]*" inner "${symbols}")
string(REGEX MATCHALL "[^\n]* [A-Za-z] radar::(ContactPass|ContactSubmitter|ObjectTree|GpuScene|SampledSubmitter)::[^\n]*" more "${symbols}")
if(inner OR more OR NOT symbols MATCHES "radar::Sweeper::run")
  message(FATAL_ERROR "expected the shared library to export exactly its interface; inner symbols that it exports:\n${inner}\n${more}")
endif()
