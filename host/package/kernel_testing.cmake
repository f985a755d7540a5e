# libtopple_kernel_testing: what tests and measures the kernels of other programs as topple's own are (kernels/README.md).
# Its users see topple::kernel_testing.
get_target_property(NATIVE topple_probes TOPPLE_NATIVE)
set(PARTS topple_kernel_perf topple_probes ${NATIVE})
list(TRANSFORM PARTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE OBJECTS)
add_library(libtopple_kernel_testing STATIC ${OBJECTS})
add_library(topple::kernel_testing ALIAS libtopple_kernel_testing)
target_link_libraries(libtopple_kernel_testing INTERFACE topple::kernels $<BUILD_INTERFACE:$<TARGET_NAME_IF_EXISTS:GTest::gtest>>
                      $<INSTALL_INTERFACE:GTest::gtest>)
file(GLOB HEADERS CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/include/topple/kernel_testing/*.h)
target_sources(libtopple_kernel_testing PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}/include FILES ${HEADERS})
set_target_properties(libtopple_kernel_testing PROPERTIES
  OUTPUT_NAME topple_kernel_testing EXPORT_NAME kernel_testing LINKER_LANGUAGE CXX)
