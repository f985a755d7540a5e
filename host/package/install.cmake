# What `cmake --install` puts under its prefix: the CMake package `topple` with its components; of all of topple also
# the program, libtopple with its headers, and the readers, which both run. Else neither reads files of its own at run
# time.
include(CMakePackageConfigHelpers)
set(PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/topple)
# topple_component(NAME TARGET): topple::<its EXPORT_NAME>, as component NAME.
function(topple_component NAME TARGET)
  configure_file(${CMAKE_CURRENT_SOURCE_DIR}/package/topple-${NAME}.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/topple-${NAME}.cmake @ONLY)
  install(TARGETS ${TARGET} EXPORT topple-${NAME}-targets FILE_SET HEADERS)
  install(EXPORT topple-${NAME}-targets NAMESPACE topple:: DESTINATION ${PACKAGE_FOLDER})
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/topple-${NAME}.cmake DESTINATION ${PACKAGE_FOLDER})
endfunction()
configure_package_config_file(${CMAKE_CURRENT_SOURCE_DIR}/package/toppleConfig.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/toppleConfig.cmake
                              INSTALL_DESTINATION ${PACKAGE_FOLDER} NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/toppleConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/toppleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/toppleConfigVersion.cmake
        DESTINATION ${PACKAGE_FOLDER})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/package/NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The dialect and the tools lie as they do in the source; so does perf.
set(KERNELS_FOLDER ${CMAKE_INSTALL_DATADIR}/topple/kernels)
file(RELATIVE_PATH KERNELS_FROM_PACKAGE /prefix/${PACKAGE_FOLDER} /prefix/${KERNELS_FOLDER})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/kernels/dialect DESTINATION ${KERNELS_FOLDER})
install(PROGRAMS ${PROJECT_SOURCE_DIR}/kernels/tools/build_kernels.py DESTINATION ${KERNELS_FOLDER}/tools)
install(FILES ${PROJECT_SOURCE_DIR}/kernels/tools/check_bounds.py ${PROJECT_SOURCE_DIR}/kernels/tools/topple_add_kernels.cmake
              ${PROJECT_SOURCE_DIR}/kernels/tools/topple_add_kernel_cases.cmake ${PROJECT_SOURCE_DIR}/kernels/tools/native_flags.txt
        DESTINATION ${KERNELS_FOLDER}/tools)
install(PROGRAMS ${PROJECT_SOURCE_DIR}/perf/compare DESTINATION ${CMAKE_INSTALL_DATADIR}/topple/perf)
install(FILES ${PROJECT_SOURCE_DIR}/perf/rule.py ${PROJECT_SOURCE_DIR}/perf/side.py DESTINATION ${CMAKE_INSTALL_DATADIR}/topple/perf)
topple_component(kernels libtopple_kernels)
topple_component(kernel_primitives libtopple_kernel_primitives)
topple_component(kernel_testing libtopple_kernel_testing)
if(TOPPLE_ONLY)
  return()
endif()
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
topple_component(library libtopple)
install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/package/find_openvdb.cmake DESTINATION ${PACKAGE_FOLDER})
