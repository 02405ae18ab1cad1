include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

run(${PROGRAM} --headless --agents 100 --frames 2 --size 160x90 --out pictures)
if(NOT output MATCHES "SYNC-HAZARD-READ-AFTER-WRITE")
  message(FATAL_ERROR "validation has not noticed the missing barrier:\n${output}")
endif()
