# Makes TO/cyber-radar-VERSION-linux-x86_64.tar.xz, and its checksum beside it: cmake -DPROGRAMS=... -P archive.cmake.
cmake_minimum_required(VERSION 3.25)
set(name cyber-radar-${VERSION}-linux-x86_64)
include(${CMAKE_CURRENT_LIST_DIR}/contents.cmake)
gather_programs()

# Something to try it with: the paper's boxes and teapots.
execute_process(COMMAND ${PROGRAMS} workload figure7 --teapots 6 --boxes 60 --steps 4 --out ${root}/meshes
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${root}/meshes/mesh-0.ply ${root}/meshes/box.ply)
file(RENAME ${root}/meshes/mesh-1.ply ${root}/meshes/teapot.ply)
file(READ ${root}/meshes/queries.json queries)
string(REPLACE "mesh-0.ply" "box.ply" queries "${queries}")
string(REPLACE "mesh-1.ply" "teapot.ply" queries "${queries}")
file(WRITE ${root}/meshes/queries.json "${queries}")

gather_licences()
configure_file(${CMAKE_CURRENT_LIST_DIR}/README.txt.in ${root}/README.txt @ONLY)
set(SUFFIX xz)
pack()
