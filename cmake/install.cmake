# libmerlin.so with the functions of include/merlin and nothing else, and what make install puts where.
include(GNUInstallDirs)

add_library(libmerlin SHARED $<TARGET_OBJECTS:merlin_image> $<TARGET_OBJECTS:merlin_model>
  $<TARGET_OBJECTS:merlin_mesh> $<TARGET_OBJECTS:merlin_estimate> $<TARGET_OBJECTS:merlin_stereo>
  $<TARGET_OBJECTS:merlin_nfps> $<TARGET_OBJECTS:merlin_photo_stereo> $<TARGET_OBJECTS:merlin_surfaces> $<TARGET_OBJECTS:merlin_view>
  $<TARGET_OBJECTS:merlin_export> $<TARGET_OBJECTS:merlin_rti> $<TARGET_OBJECTS:merlin_sequence>)
target_link_libraries(libmerlin PRIVATE merlin_mesh merlin_estimate merlin_stereo merlin_nfps merlin_photo_stereo
  merlin_surfaces merlin_view merlin_export merlin_rti merlin_sequence)
# before 1.0 what was built with one minor version may not run with another
set_target_properties(libmerlin PROPERTIES OUTPUT_NAME merlin VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/libmerlin.map)
target_link_options(libmerlin PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/libmerlin.map)
if(NOT MERLIN_SANITIZE AND NOT MERLIN_FUZZ)
  target_link_options(libmerlin PRIVATE -Wl,--no-undefined)
endif()

foreach(name relight_photo photo_to_mesh capture_to_surface)
  add_executable(${name} EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/examples/${name}.c)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(${name} PRIVATE libmerlin m)
endforeach()

# Both descriptions find their prefix from where they lie, because make install chooses it after this file is read.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
  OUTPUT_VARIABLE MERLIN_UP)
configure_file(${PROJECT_SOURCE_DIR}/cmake/merlin.pc.in merlin.pc @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/cmake/merlin-config.cmake.in merlin-config.cmake @ONLY)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(merlin-config-version.cmake COMPATIBILITY SameMinorVersion)
target_include_directories(libmerlin INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
if(MERLIN_LEVEL)
  include(cmake/package.cmake)
else()
  install(TARGETS merlin)
endif()
if(MERLIN_LEVEL AND NOT MERLIN_LEVEL STREQUAL all)
  return() # the rest is in the package by the build for all
endif()
if(TARGET merlin-lab)
  install(TARGETS merlin-lab)
endif()
if(TARGET merlin_mpi)
  install(TARGETS merlin_mpi DESTINATION ${CMAKE_INSTALL_LIBDIR}/merlin)
endif()
set_target_properties(libmerlin PROPERTIES EXPORT_NAME merlin)
install(TARGETS libmerlin EXPORT merlin-targets)
install(EXPORT merlin-targets NAMESPACE merlin:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/merlin)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/merlin-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/merlin-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/merlin)
install(DIRECTORY include/merlin TYPE INCLUDE)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/merlin.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY models DESTINATION ${CMAKE_INSTALL_DATADIR}/merlin)
install(FILES completions/_merlin DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
foreach(program merlin merlin-lab)
  if(TARGET ${program})
    install(FILES man/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    install(FILES completions/merlin.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
      RENAME ${program})
    install(FILES completions/merlin.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
      RENAME ${program}.fish)
  endif()
endforeach()
