# The soak: a command, and a short run of it as a test.
add_executable(radar_soak
  embed/host.cpp embed/host_world.cpp faults/host_memory.cpp fuzz/check_answers.cpp fuzz/check_recorded.cpp
  fuzz/scene_calls.cpp soak/answerers.cpp soak/batch.cpp soak/hard_world.cpp soak/main.cpp soak/memory.cpp
  soak/moved_answerers.cpp soak/wild_world.cpp support/scene_model.cpp support/separate_allocations.cpp support/test_device.cpp
  support/watched_vulkan.cpp)
target_include_directories(radar_soak PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/engine)
target_link_libraries(radar_soak PRIVATE CyberRadar::radar radar_oracle radar_sweep radar_gpu radar_shaders
  radar_workloads radar_commit radar_command Vulkan::Vulkan ${CMAKE_DL_LIBS} radar_warnings)
set(sentence "soak: random edits, batches, recordings and faults leave every answer right and nothing behind")
add_test(NAME "${sentence}" COMMAND radar_soak --rounds 40 --scene-rounds 2 --epoch-rounds 40)
set_tests_properties("${sentence}" PROPERTIES ENVIRONMENT "${validation};${two_devices}")
