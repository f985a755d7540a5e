# What `cmake --install` puts under its prefix: the program, libtopple with its headers, and the CMake
# package `topple`. Neither the program nor the library reads files of its own at run time.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/topple)
configure_package_config_file(${CMAKE_CURRENT_SOURCE_DIR}/package/toppleConfig.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/toppleConfig.cmake
                              INSTALL_DESTINATION ${PACKAGE_FOLDER})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/toppleConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(TARGETS topple)
install(TARGETS libtopple EXPORT toppleTargets FILE_SET HEADERS)
install(EXPORT toppleTargets NAMESPACE topple:: DESTINATION ${PACKAGE_FOLDER})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/toppleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/toppleConfigVersion.cmake
              ${CMAKE_CURRENT_SOURCE_DIR}/package/find_openvdb.cmake
        DESTINATION ${PACKAGE_FOLDER})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
