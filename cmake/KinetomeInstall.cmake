# install(): the program, the libraries, their headers and a package configuration.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
get_property(layers GLOBAL PROPERTY KINETOME_LAYERS)
if(TARGET kinetome)
  install(TARGETS kinetome RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS ${layers} EXPORT KinetomeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/kinetome DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Kinetome)
install(EXPORT KinetomeTargets NAMESPACE kinetome:: DESTINATION ${package_dir})
configure_package_config_file(cmake/KinetomeConfig.cmake.in
  ${PROJECT_BINARY_DIR}/KinetomeConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/KinetomeConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/KinetomeConfig.cmake ${PROJECT_BINARY_DIR}/KinetomeConfigVersion.cmake
  cmake/KinetomeDependencies.cmake cmake/FindxxHash.cmake
  cmake/FindFLANN.cmake
  DESTINATION ${package_dir})
install(DIRECTORY jobs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/kinetome/jobs USE_SOURCE_PERMISSIONS)
