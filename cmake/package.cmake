# The Debian package (make deb) of several builds: one for all processors and, on x86-64, one for each level that is worth
# it. src/launch starts the program of the best level, the system's loader takes the library of it (glibc-hwcaps).
install(TARGETS merlin DESTINATION lib/merlin/${MERLIN_LEVEL})
if(NOT MERLIN_LEVEL STREQUAL all)
  install(TARGETS libmerlin LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${MERLIN_LEVEL} NAMELINK_SKIP)
  return()
endif()

add_executable(merlin-launch src/launch/launch.c)
set_target_properties(merlin-launch PROPERTIES OUTPUT_NAME launch/merlin)
install(TARGETS merlin-launch)
install(DIRECTORY python/merlin DESTINATION lib/python3/dist-packages
  FILES_MATCHING PATTERN "*.py" PATTERN py.typed PATTERN __pycache__ EXCLUDE)

# packages_of(OUT files...): the packages that the files are from, separated by commas.
function(packages_of out)
  set(owners)
  foreach(file ${ARGN})
    file(REAL_PATH ${file} file)
    execute_process(COMMAND dpkg-query -S ${file} OUTPUT_VARIABLE owner OUTPUT_STRIP_TRAILING_WHITESPACE
      COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE ":.*" "" owner ${owner})
    list(APPEND owners ${owner})
  endforeach()
  list(JOIN owners ", " owners)
  set(${out} ${owners} PARENT_SCOPE)
endfunction()

# What libraries that are loaded by name are packaged as: their links do not show them. Videos alone need FFmpeg's, with
# all that they bring.
packages_of(loaded ${VIPS_FILE} ${LIBRAW_FILE} ${CHOLMOD_FILE} ${MICROHTTPD_FILE} ${MERLIN_FONT})
packages_of(for_videos ${AVFORMAT_FILE} ${AVCODEC_FILE} ${AVUTIL_FILE} ${SWSCALE_FILE})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME merlin)
set(CPACK_PACKAGE_CONTACT "the merlin authors <merlin@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "material, shape and new light of an object from one photograph")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "merlin takes one photograph of an object apart into albedo, normals, depth and
roughness, shows it under other light, and solves photometric stereo. The package has the
commands, libmerlin with its headers, the Python module and the weights.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_CURRENT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_DEPENDS "${loaded}")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy, ${for_videos}")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
# A new list of shared libraries after the package has come and gone.
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/triggers)
set(CPACK_INSTALL_CMAKE_PROJECTS "")
foreach(level all x86-64-v3 x86-64-v4)
  cmake_path(REPLACE_FILENAME CMAKE_CURRENT_BINARY_DIR ${level} OUTPUT_VARIABLE folder)
  if(level STREQUAL all OR CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)
    list(APPEND CPACK_INSTALL_CMAKE_PROJECTS ${folder} merlin ALL /)
  endif()
endforeach()
include(CPack)
