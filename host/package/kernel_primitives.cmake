# libtopple_kernel_primitives: data-parallel primitives on the buffers of devices, for other programs (kernels/README.md).
# Its users see topple::kernel_primitives.
get_target_property(NATIVE topple_primitive_kernels TOPPLE_NATIVE)
set(PARTS topple_primitives topple_primitive_kernels ${NATIVE})
list(TRANSFORM PARTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE OBJECTS)
add_library(libtopple_kernel_primitives STATIC ${OBJECTS})
add_library(topple::kernel_primitives ALIAS libtopple_kernel_primitives)
target_link_libraries(libtopple_kernel_primitives INTERFACE topple::kernels)
file(GLOB HEADERS CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/include/topple/kernels/primitives/*.h)
target_sources(libtopple_kernel_primitives PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}/include FILES ${HEADERS})
set_target_properties(libtopple_kernel_primitives PROPERTIES
  OUTPUT_NAME topple_kernel_primitives EXPORT_NAME kernel_primitives LINKER_LANGUAGE CXX)
