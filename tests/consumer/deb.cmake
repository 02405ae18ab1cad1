# Builds the Debian package, checks its contents, unpacks it and runs its program: cmake -DBUILD=... -P deb.cmake.
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
execute_process(COMMAND ${CPACK} -G DEB -B ${FOLDER} WORKING_DIRECTORY ${BUILD} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB deb ${FOLDER}/cyber-radar_${VERSION}_*.deb)

execute_process(COMMAND dpkg-deb -f ${deb} OUTPUT_VARIABLE fields COMMAND_ERROR_IS_FATAL ANY)
foreach(expected "Package: cyber-radar\n" "Version: ${VERSION}\n" "Section: libdevel\n" "Maintainer: [^\n]+@"
        "Depends:[^\n]* libvulkan1" "Depends:[^\n]* libassimp" "Depends:[^\n]* libc6 [(]>="
        "Recommends: libvulkan-dev\n" "Description: [^\n]+\n [^\n]+")
  if(NOT fields MATCHES "${expected}")
    message(FATAL_ERROR "expected \"${expected}\" among the fields of ${deb}:\n${fields}")
  endif()
endforeach()

execute_process(COMMAND dpkg-deb -c ${deb} OUTPUT_VARIABLE contents COMMAND_ERROR_IS_FATAL ANY)
foreach(file bin/cyber-radar include/radar/radar.h lib/libcyber-radar.a lib/cmake/CyberRadar/CyberRadarConfig.cmake
        lib/pkgconfig/cyber-radar.pc share/doc/cyber-radar/copyright share/man/man1/cyber-radar.1
        share/bash-completion/completions/cyber-radar share/zsh/vendor-completions/_cyber-radar)
  string(FIND "${contents}" " ./usr/${file}\n" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "expected /usr/${file} in ${deb}:\n${contents}")
  endif()
endforeach()
if(NOT contents MATCHES "^drwxr-xr-x root/root ")
  message(FATAL_ERROR "expected the files of ${deb} to belong to root:\n${contents}")
endif()

execute_process(COMMAND dpkg-deb -x ${deb} ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
set(program ${FOLDER}/usr/bin/cyber-radar)
execute_process(COMMAND ${program} workload table1 --boxes 100 --sensors 4 --out ${FOLDER}/table1
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${program} query ${FOLDER}/table1/queries.json OUTPUT_VARIABLE answers COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\"status\": \"(hit|clear|overlap)\"" answered "${answers}")
list(LENGTH answered count)
if(NOT count EQUAL 4)
  message(FATAL_ERROR "expected 4 answers, got:\n${answers}")
endif()

if(PYTHON)
  if(NOT fields MATCHES "Depends:[^\n]* python3 [(]>= 3[.][0-9]+[)], python3 [(]<< 3[.][0-9]+[)], python3-numpy")
    message(FATAL_ERROR "expected ${deb} to depend on Python's version and on numpy:\n${fields}")
  endif()
  set(asked "import cyber_radar
scene = cyber_radar.Scene()
plate = scene.add_mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
scene.add(plate, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -2], [0, 0, 0, 1]])
print(cyber_radar.__file__, scene.cast(plate, None, [0, 0, -3]).t)")
  set(packages ${FOLDER}/usr/lib/python3/dist-packages)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${packages} PYTHONDONTWRITEBYTECODE=1 ${PYTHON} -c "${asked}"
    OUTPUT_VARIABLE answer COMMAND_ERROR_IS_FATAL ANY)
  if(NOT answer STREQUAL "${packages}/cyber_radar/__init__.py 2.0\n")
    message(FATAL_ERROR "expected the Python package in ${packages} to answer 2.0, got ${answer}")
  endif()
  if(NOT EXISTS ${packages}/cyber_radar/py.typed OR NOT EXISTS ${packages}/cyber_radar/_engine.pyi)
    message(FATAL_ERROR "expected the types of the Python package in ${packages}")
  endif()
endif()
