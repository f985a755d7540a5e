# libtopple_kernels: devices, buffers and queues, for programs with kernels of their own (kernels/README.md). Its
# users see topple::kernels, installed or by add_subdirectory. Its objects are libtopple's own, so that one
# program may link both.
set(PARTS topple_base topple_child topple_device)
list(TRANSFORM PARTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE OBJECTS)
add_library(libtopple_kernels ${OBJECTS})
add_library(topple::kernels ALIAS libtopple_kernels)
target_link_libraries(libtopple_kernels PRIVATE Threads::Threads OpenCL::OpenCL Vulkan::Vulkan)
file(GLOB HEADERS CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/include/topple/kernels/*.h)
list(TRANSFORM HEADERS REPLACE ".*/" "topple/kernels/")
list(APPEND HEADERS topple/device.h topple/embed.h topple/error.h)
list(TRANSFORM HEADERS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/include/)
target_sources(libtopple_kernels PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}/include FILES ${HEADERS})
target_compile_features(libtopple_kernels INTERFACE cxx_std_20)
set_target_properties(libtopple_kernels PROPERTIES
  OUTPUT_NAME topple_kernels EXPORT_NAME kernels LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
