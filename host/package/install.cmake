# What `cmake --install` puts under its prefix: the program, libtopple with its headers, and the CMake
# package `topple`, and the readers, which both run. Else neither reads files of its own at run time.
include(CMakePackageConfigHelpers)
set(PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/topple)
configure_package_config_file(${CMAKE_CURRENT_SOURCE_DIR}/package/toppleConfig.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/toppleConfig.cmake
                              INSTALL_DESTINATION ${PACKAGE_FOLDER})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/toppleConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
# For what is not built by CMake. A static libtopple takes with it what it needs, a shared one has it.
file(RELATIVE_PATH TOPPLE_PREFIX_FROM_PC /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
set(TOPPLE_PC_LIBS "")
set(TOPPLE_PC_REQUIRES "")
if(NOT BUILD_SHARED_LIBS)
  set(TOPPLE_PC_REQUIRES " Imath")  # of OpenVDB: its library has the version in its name
  list(TRANSFORM TOPPLE_LINKED_LIBRARIES PREPEND " -l" OUTPUT_VARIABLE TOPPLE_PC_LIBS)
  string(JOIN "" TOPPLE_PC_LIBS ${TOPPLE_PC_LIBS})
endif()
configure_file(${CMAKE_CURRENT_SOURCE_DIR}/package/topple.pc.in ${CMAKE_CURRENT_BINARY_DIR}/topple.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/topple.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(TARGETS topple)
install(TARGETS topple-reader topple-volume-reader topple-lab RUNTIME DESTINATION ${TOPPLE_LIBEXECDIR})
if(TARGET topple-mujoco)
  install(TARGETS topple-mujoco RUNTIME DESTINATION ${TOPPLE_LIBEXECDIR})
endif()
if(TARGET topple-mpi)
  install(TARGETS topple-mpi RUNTIME OPTIONAL)  # ./dev demo leaves it out
endif()
install(TARGETS libtopple EXPORT toppleTargets FILE_SET HEADERS)
install(EXPORT toppleTargets NAMESPACE topple:: DESTINATION ${PACKAGE_FOLDER})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/toppleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/toppleConfigVersion.cmake
              ${CMAKE_CURRENT_SOURCE_DIR}/package/find_openvdb.cmake
        DESTINATION ${PACKAGE_FOLDER})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/package/NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
