# The target `gpu-bundle` (./tools/bootstrap gpu-bundle), and a test that makes it and runs it on lavapipe.
set(bundled cyber-radar radar_random_queries agreement_tests gpu_tests embed_tests)
list(TRANSFORM bundled REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE bundled_files)
get_target_property(launcher_folder cyber-radar-launcher RUNTIME_OUTPUT_DIRECTORY)
add_custom_target(gpu-bundle
  COMMAND ${CMAKE_COMMAND} "-DPROGRAMS=${bundled_files}" -DLAUNCHER=$<TARGET_FILE:cyber-radar-launcher>
          -DMAPS=${launcher_folder}/cyber-radar.map -DASSIMP=${assimp_models} -DCGAL=${cgal_meshes}/data/meshes
          -DCGAL_ARCHIVE=${cgal_archive} -DSOURCE=${PROJECT_SOURCE_DIR} -DTO=${PROJECT_BINARY_DIR}
          -P ${CMAKE_CURRENT_LIST_DIR}/gpu_bundle.cmake
  DEPENDS ${bundled} cyber-radar-launcher
  USES_TERMINAL VERBATIM)

set(bundle_test "package: the bundle for machines with a GPU runs on a system that has only a shell and a driver")
add_test(NAME "${bundle_test}"
  COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DDRIVER=${lavapipe}
          -DFOLDER=${CMAKE_CURRENT_BINARY_DIR}/bare_bundle -DCACHE=${shader_caches}/native
          -P ${CMAKE_CURRENT_LIST_DIR}/run_bundle.cmake)
# Alone, for its parts have limits in seconds, and building it may relink programs that other tests run.
set_tests_properties("${bundle_test}" PROPERTIES RUN_SERIAL ON ${if_skipped} "skipped: ")
