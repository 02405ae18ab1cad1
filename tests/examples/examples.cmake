# The examples, each run with validation on; what docs/embedding.md quotes of them.
function(radar_example name expression)
  set(name "examples: ${name}, without a word of validation")
  add_test(NAME "${name}" COMMAND ${ARGN})
  set_tests_properties("${name}" PROPERTIES ENVIRONMENT "${validation}" PASS_REGULAR_EXPRESSION "${expression}"
    FAIL_REGULAR_EXPRESSION "Validation|VUID|SYNC-HAZARD")
endfunction()

radar_example("the recorder's crates come to rest" "all crates lie still, and none touches anything" radar-example-recorder)
set(recorder ${PROJECT_SOURCE_DIR}/tools/examples/recorder)
add_test(NAME "examples: what docs/embedding.md shows of the recorder is cut from its sources"
  COMMAND ${CMAKE_COMMAND} -DPAGE=${PROJECT_SOURCE_DIR}/docs/embedding.md
          "-DSOURCES=${recorder}/recorder.cpp;${recorder}/ask.comp.glsl;${recorder}/move.comp.glsl"
          -P ${CMAKE_CURRENT_SOURCE_DIR}/examples/cut.cmake)

find_program(XVFB_RUN xvfb-run)
if(NOT TARGET radar-example-renderer OR NOT XVFB_RUN)
  add_test(NAME "examples: the renderer" COMMAND ${CMAKE_COMMAND} -E echo
    "skipped: the renderer is not built, or there is no display (Debian: libglfw3-dev libpng-dev xvfb xauth)")
  set_tests_properties("examples: the renderer" PROPERTIES ${if_skipped} "skipped: ")
else()
  set(pictures ${CMAKE_CURRENT_BINARY_DIR}/pictures)
  file(MAKE_DIRECTORY ${pictures})
  set(flawless "queries: [1-9][0-9]+, without an answer: 0\nchecks by the CPU:")
  radar_example("the renderer's agents never cross" "${flawless} 12, crossings: 0\n" radar-example-renderer 200 600 ${pictures})
  radar_example("the renderer opens a window" "${flawless} 1, crossings: 0\n"
    ${XVFB_RUN} -a -s "-screen 0 1024x768x24" $<TARGET_FILE:radar-example-renderer> 50 60)
endif()
