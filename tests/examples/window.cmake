include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

find_program(XVFB_RUN xvfb-run)
if(NOT XVFB_RUN)
  message("skipped: there is no display for the test's window (Debian: xvfb xauth)")
  return()
endif()
run(${XVFB_RUN} -a -s "-screen 0 640x480x24" ${PROGRAM} --agents 100 --frames 60 --size 320x180 --show contacts)
expect_quiet("medians of 60 frames" "without an answer: 0\n" "checks by the CPU: 2, crossings: 0\n")
