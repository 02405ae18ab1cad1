# The soak: a command, and a short run of it as a test.
add_executable(radar_soak
  faults/host_memory.cpp soak/answerers.cpp soak/batch.cpp soak/hard_world.cpp soak/main.cpp soak/memory.cpp
  soak/moved_answerers.cpp soak/wild_world.cpp support/separate_allocations.cpp support/test_device.cpp)
target_include_directories(radar_soak PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/engine)
target_link_libraries(radar_soak PRIVATE radar_host CyberRadar::radar radar_sweep radar_gpu radar_shaders
  radar_workloads radar_commit radar_command ${CMAKE_DL_LIBS} radar_warnings)
target_compile_options(radar_soak PRIVATE $<$<CONFIG:Release>:-O1>)
set(sentence "soak: random edits, batches, recordings and faults leave every answer right and nothing behind")
add_test(NAME "${sentence}" COMMAND radar_soak --rounds 40 --scene-rounds 2 --epoch-rounds 40)
set_tests_properties("${sentence}" PROPERTIES ENVIRONMENT "${validation};${two_devices}")
