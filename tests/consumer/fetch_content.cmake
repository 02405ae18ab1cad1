# Configures a project with -ffast-math that takes the library as a shared one by FetchContent, and looks at how the engine
# would be compiled in it; compiling it takes minutes. cmake -DSOURCE=... -DFOLDER=... -DCXX=... -P fetch_content.cmake.
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer/project -B ${FOLDER} -G Ninja -DHOW=FetchContent
  -DSOURCE=${SOURCE} -DCMAKE_CXX_FLAGS=-ffast-math -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
  COMMAND_ERROR_IS_FATAL ANY)
file(READ ${FOLDER}/compile_commands.json commands)
string(JSON count LENGTH "${commands}")
math(EXPR last "${count} - 1")
set(checked 0)
foreach(i RANGE ${last})
  string(JSON file GET "${commands}" ${i} file)
  string(JSON command GET "${commands}" ${i} command)
  if(NOT file MATCHES "^${SOURCE}/engine/")
    continue()
  endif()
  math(EXPR checked "${checked} + 1")
  if(NOT command MATCHES " -ffast-math.* -fno-fast-math " OR NOT command MATCHES " -DRADAR_EXPORTS " OR
     NOT command MATCHES " -fvisibility=hidden ")
    message(FATAL_ERROR "${file}: expected -fno-fast-math after -ffast-math, RADAR_EXPORTS and hidden symbols, got\n${command}")
  endif()
endforeach()
if(checked LESS 50)
  message(FATAL_ERROR "expected at least 50 files of the engine, got ${checked}")
endif()
