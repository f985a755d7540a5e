# Finds OpenVDB by the find module that it brings. Debian keeps that off CMake's path; and it sets
# BUILD_SHARED_LIBS for whoever calls it, so it is called in a scope of its own. There it says nothing
# below a warning: it prints its components' names, QUIET or not, and Imath's package that Debian ships
# without its Python module.
function(topple_find_openvdb)
  set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
  list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
  find_package(OpenVDB QUIET)
  set(OpenVDB_FOUND ${OpenVDB_FOUND} PARENT_SCOPE)
  set(OpenVDB_INCLUDE_DIRS ${OpenVDB_INCLUDE_DIRS} PARENT_SCOPE)
endfunction()
