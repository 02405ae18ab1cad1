# Fuzz targets. Here they run their seeds and a fixed number of mutations. With RADAR_FUZZ (preset fuzz) they are programs
# of libFuzzer, of which the tests are short runs; tests/fuzz/run makes long ones.
option(RADAR_FUZZ "Build the fuzz targets with libFuzzer (needs clang)" OFF)
add_custom_target(fuzz_targets)
if(RADAR_FUZZ)
  # It is no part of what is tested, and slow under sanitizers.
  target_compile_options(radar_oracle PRIVATE -fno-sanitize=all)
endif()

if(NOT RADAR_FUZZ)
  add_library(fuzz_main OBJECT fuzz/seeded_main.cpp)
  target_include_directories(fuzz_main PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(fuzz_main PUBLIC radar_workloads radar_command PRIVATE radar_warnings)
endif()

# MUTATIONS: how many a test runs.
function(radar_fuzz name sentence)
  cmake_parse_arguments(arg "" "MUTATIONS" "SOURCES;LINK" ${ARGN})
  set(program fuzz_${name})
  add_executable(${program} fuzz/${name}.cpp ${arg_SOURCES})
  target_include_directories(${program} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/engine)
  target_link_libraries(${program} PRIVATE radar_checks ${arg_LINK} radar_warnings)
  target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_compile_definitions(${program} PRIVATE RADAR_ASSIMP_MODELS="${assimp_models}")
  add_dependencies(fuzz_targets ${program})
  if(RADAR_FUZZ)
    target_sources(${program} PRIVATE fuzz/libfuzzer_main.cpp)
    target_link_options(${program} PRIVATE -fsanitize=fuzzer)
    set(command ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/run $<TARGET_FILE:${program}> ${CMAKE_CURRENT_BINARY_DIR}/fuzz/${name}
        -runs=${arg_MUTATIONS} -seed=1)
  else()
    target_link_libraries(${program} PRIVATE fuzz_main)
    set(command ${program} --runs ${arg_MUTATIONS})
  endif()
  add_test(NAME "fuzz: ${sentence}" COMMAND ${command})
  set_tests_properties("fuzz: ${sentence}" PROPERTIES ENVIRONMENT "${validation}")
endfunction()

add_library(fuzz_batch STATIC fuzz/check_batch.cpp)
target_include_directories(fuzz_batch PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/engine)
target_link_libraries(fuzz_batch PUBLIC radar_checks radar_batch PRIVATE radar_warnings)
target_compile_options(fuzz_batch PRIVATE $<$<CONFIG:Release>:-O1>)
radar_fuzz(mesh_file "any bytes are read or refused as OBJ, STL, PLY, OFF, glTF and 3MF files" MUTATIONS 7000 LINK radar_import ZLIB::ZLIB)
radar_fuzz(cpu_calls "any calls of the interface keep its contracts, and the CPU's answers are exact" MUTATIONS 3000)
radar_fuzz(query_file "any bytes are read or refused as a query file, and what is read is answered" MUTATIONS 5000
  LINK fuzz_batch)
radar_fuzz(query_arrays "any arrays are read or refused as queries, and what is read is answered" MUTATIONS 5000
  LINK fuzz_batch)
radar_fuzz(part_file "any bytes are merged, resumed or refused as a shard's answers" MUTATIONS 5000
  LINK fuzz_batch)
radar_fuzz(device_calls "any calls get the CPU's answers from a sweeper, and from a recorder of any capacity, or say which limit was too small" MUTATIONS 120
  SOURCES fuzz/check_recorded.cpp support/test_device.cpp LINK radar_sweep radar_gpu radar_shaders)
