# The example renderer, with validation on: its frames, its window, and that validation would notice a missing barrier.
set(renderer_folder ${CMAKE_CURRENT_BINARY_DIR}/renderer)
set(renderer_tests "1,000 frames without a crossing or a word of validation" "a window, without a word of validation"
  "synchronization validation notices a barrier that is left out" "what cannot be done ends with status 2 and leaves nothing")
list(TRANSFORM renderer_tests PREPEND "renderer: ")
if(NOT TARGET radar-example-renderer)
  foreach(name ${renderer_tests})
    add_test(NAME "${name}" COMMAND ${CMAKE_COMMAND} -E echo
      "skipped: the example is not built (Debian: libglfw3-dev libgif-dev libpng-dev)")
    set_tests_properties("${name}" PROPERTIES ${if_skipped} "skipped: ")
  endforeach()
  return()
endif()

# Differs in one file from the example.
find_package(GIF REQUIRED)
find_package(PNG REQUIRED)
find_package(glfw3 REQUIRED)
get_target_property(renderer_sources radar-example-renderer SOURCE_DIR)
get_target_property(renderer_libraries radar-example-renderer LINK_LIBRARIES)
get_target_property(renderer_includes radar-example-renderer INCLUDE_DIRECTORIES)
add_executable(renderer_without_barrier ${renderer_sources}/agents.cpp
  $<FILTER:$<TARGET_OBJECTS:radar-example-renderer>,EXCLUDE,/agents\\.cpp>)
add_dependencies(renderer_without_barrier radar-example-renderer)
target_compile_definitions(renderer_without_barrier PRIVATE RADAR_EXAMPLE_LEAVE_OUT_BARRIER)
target_include_directories(renderer_without_barrier PRIVATE ${renderer_includes})
target_link_libraries(renderer_without_barrier PRIVATE ${renderer_libraries})

function(renderer_test index program check)
  list(GET renderer_tests ${index} name)
  add_test(NAME "${name}"
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${program}> -DFOLDER=${renderer_folder}_${index} ${ARGN}
            -P ${CMAKE_CURRENT_SOURCE_DIR}/examples/${check}.cmake)
  set_tests_properties("${name}" PROPERTIES ENVIRONMENT "${validation}" ${if_skipped} "skipped: ")
endfunction()
renderer_test(0 radar-example-renderer headless)
renderer_test(1 radar-example-renderer window)
renderer_test(2 renderer_without_barrier barrier)
renderer_test(3 radar-example-renderer refusals)
