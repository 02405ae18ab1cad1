# A second device on any machine: the loader lists one device per driver file, so a copy of the lavapipe library with a
# driver file of its own is a second lavapipe. Sets `two_lavapipes`, the value of VK_DRIVER_FILES that lists both, and
# `lavapipe`, the library of the first.
file(GLOB installed /usr/share/vulkan/icd.d/lvp_icd*.json /usr/local/share/vulkan/icd.d/lvp_icd*.json
  /etc/vulkan/icd.d/lvp_icd*.json)
if(NOT installed)
  message(FATAL_ERROR "lvp_icd*.json is in no folder of Vulkan drivers: the tests of several devices need Mesa's "
    "software device (Debian: mesa-vulkan-drivers)")
endif()
list(GET installed 0 first_lavapipe)
file(READ ${first_lavapipe} driver)
string(JSON lavapipe GET "${driver}" ICD library_path)
if(NOT IS_ABSOLUTE "${lavapipe}")
  if(lavapipe MATCHES "/")  # relative to the driver file
    get_filename_component(lavapipe "${lavapipe}" ABSOLUTE BASE_DIR ${first_lavapipe}/..)
  else()
    find_library(RADAR_LAVAPIPE ${lavapipe} REQUIRED)
    set(lavapipe ${RADAR_LAVAPIPE})
  endif()
endif()
# The copy keeps the file name, so that ThreadSanitizer's suppression of libvulkan_lvp.so applies to both.
set(second_folder ${CMAKE_CURRENT_BINARY_DIR}/second_lavapipe)
get_filename_component(library_name "${lavapipe}" NAME)
file(REAL_PATH "${lavapipe}" lavapipe)
configure_file("${lavapipe}" ${second_folder}/${library_name} COPYONLY)
string(JSON driver SET "${driver}" ICD library_path "\"${second_folder}/${library_name}\"")
file(WRITE ${second_folder}/lvp_icd.json "${driver}\n")
set(two_lavapipes ${first_lavapipe}:${second_folder}/lvp_icd.json)
