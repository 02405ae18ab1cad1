# Configures as pip does, with a Python that has only its standard library: cmake -DSOURCE=... -DPYTHON=... -P without_numpy.cmake.
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${PYTHON} -m venv --without-pip ${FOLDER}/venv COMMAND_ERROR_IS_FATAL ANY)
set(python ${FOLDER}/venv/bin/python)
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=PYTHONPATH ${python} -c "import numpy" RESULT_VARIABLE failed ERROR_QUIET)
if(NOT failed)
  message(FATAL_ERROR "expected ${python} to lack numpy")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=PYTHONPATH ${CMAKE_COMMAND} -S ${SOURCE} -B ${FOLDER}/build -G ${GENERATOR}
  -DRADAR_PYTHON=ON -DRADAR_TOOLS=OFF -DRADAR_TESTS=OFF -DRADAR_INSTALL=OFF -DPython_EXECUTABLE=${python}
  COMMAND_ERROR_IS_FATAL ANY)
