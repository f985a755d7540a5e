# libtopple: what host/include/topple declares and all that it takes, as one library from the objects of
# the folders' own. Its users see topple::topple, installed or by add_subdirectory (docs/architecture.md).
set(PARTS topple_api topple_base topple_child topple_compare topple_core topple_device topple_export topple_fitted topple_formats topple_geometry topple_graph
          topple_io topple_kernels topple_live topple_objects topple_physics topple_pipeline topple_points topple_reader topple_report topple_result
          topple_safety topple_scale topple_solids topple_vdb)
get_target_property(NATIVE topple_kernels TOPPLE_NATIVE)
list(APPEND PARTS ${NATIVE})
list(TRANSFORM PARTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE OBJECTS)
add_library(libtopple ${OBJECTS})
add_library(topple::topple ALIAS libtopple)
add_dependencies(libtopple topple_readers)

# What those objects need when they are linked, by package, target and library; what they need of others are headers.
set(TOPPLE_LINKED_LIBRARIES png deflate jpeg lzf qhull_r openvdb tbb OpenCL vulkan assimp octomap octomath cairo stdc++ m pthread)
set(TOPPLE_LINKED_PACKAGES Threads PNG JPEG liblzf Qhull TBB OpenCL Vulkan assimp octomap)  # and OpenVDB, cairo, libdeflate
target_link_libraries(libtopple PRIVATE Threads::Threads PNG::PNG JPEG::JPEG liblzf::liblzf Qhull::qhull_r OpenVDB::openvdb
                                        TBB::tbb OpenCL::OpenCL Vulkan::Vulkan assimp::assimp octomap cairo deflate)

set(GENERATED_HEADERS ${CMAKE_CURRENT_BINARY_DIR}/include)
file(GLOB HEADERS CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/include/topple/*.h)
target_sources(libtopple PUBLIC FILE_SET HEADERS
               BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}/include ${GENERATED_HEADERS}
               FILES ${HEADERS} ${GENERATED_HEADERS}/topple/version.h)
target_compile_features(libtopple INTERFACE cxx_std_20)
set_target_properties(libtopple PROPERTIES
  OUTPUT_NAME topple EXPORT_NAME topple LINKER_LANGUAGE CXX
  # Before 1.0 a minor version may change the interface.
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
if(BUILD_SHARED_LIBS)
  # Only the public functions: the templates inside are compiled with flags that a user's may differ from.
  set(EXPORTS ${CMAKE_CURRENT_SOURCE_DIR}/package/exports.map)
  target_link_options(libtopple PRIVATE -Wl,--version-script=${EXPORTS} -Wl,--no-undefined)
  set_target_properties(libtopple PROPERTIES LINK_DEPENDS ${EXPORTS})
endif()
