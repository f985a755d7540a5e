# topple_add_kernels(TARGET KERNELS <name>.kernel... PARAMS <file> [FUNCTIONS <file>] [NAMESPACE <name>])
#
# Builds kernels into a target of the same CMakeLists.txt that links topple::kernels. Each <name>.kernel becomes
# SPIR-V, OpenCL C and C++ (build_kernels.py beside this file), and the target includes what runs it as "<name>.hpp".
#
#   PARAMS     the STRUCTs of the kernels' parameters; "params.hpp" has them for the host
#   FUNCTIONS  what the kernels share, FN and #define
#   NAMESPACE  of the C++ that is made: TARGET::kernels, unless given. Each target has one of its own.
#
# Whatever changes, the files, the tool or the dialect, what depends on it is made anew. Errors name the files as
# they lie below PROJECT_SOURCE_DIR. TOPPLE_REVERSE_LANES=ON runs the lanes of the C++ form backwards, which shows
# races between them; TOPPLE_CHECKED_KERNELS=ON adds forms that check indices, which TOPPLE_CHECK=bounds runs.
# kernels/README.md of topple goes through it step by step.
function(topple_add_kernels TARGET)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "PARAMS;FUNCTIONS;NAMESPACE" "KERNELS")
  if(ARG_UNPARSED_ARGUMENTS OR NOT ARG_KERNELS OR NOT ARG_PARAMS)
    message(FATAL_ERROR "topple_add_kernels(${TARGET}): it takes KERNELS <name>.kernel... PARAMS <file> "
                        "[FUNCTIONS <file>] [NAMESPACE <name>], not \"${ARGN}\"")
  endif()
  set(FOLDER)
  if(TARGET ${TARGET})
    get_target_property(FOLDER ${TARGET} SOURCE_DIR)
  endif()
  if(NOT FOLDER STREQUAL CMAKE_CURRENT_SOURCE_DIR)
    message(FATAL_ERROR "topple_add_kernels(${TARGET}): there is no such target in ${CMAKE_CURRENT_SOURCE_DIR}; "
                        "call it in the CMakeLists.txt that makes the target, and behind that")
  endif()
  if(TARGET ${TARGET}_kernel_sources)
    message(FATAL_ERROR "topple_add_kernels(${TARGET}) was called before; name all KERNELS in one call")
  endif()
  if(NOT ARG_NAMESPACE)
    string(MAKE_C_IDENTIFIER ${TARGET} ARG_NAMESPACE)
    string(APPEND ARG_NAMESPACE ::kernels)
  endif()
  find_package(Python3 COMPONENTS Interpreter REQUIRED)
  find_program(TOPPLE_GLSLANG glslangValidator)
  if(NOT TOPPLE_GLSLANG)
    message(FATAL_ERROR "glslangValidator is missing: apt-get install glslang-tools")
  endif()

  cmake_path(GET CMAKE_CURRENT_FUNCTION_LIST_DIR PARENT_PATH HOME)
  set(GENERATED ${CMAKE_CURRENT_BINARY_DIR}/generated/${TARGET})
  cmake_path(ABSOLUTE_PATH ARG_PARAMS)
  set(TOOL ${HOME}/tools/build_kernels.py)
  set(CALL ${Python3_EXECUTABLE} ${TOOL} ${GENERATED} --params ${ARG_PARAMS} --namespace ${ARG_NAMESPACE}
           --root ${PROJECT_SOURCE_DIR})
  set(HEADERS ${GENERATED}/params.hpp)
  add_custom_command(OUTPUT ${HEADERS} COMMAND ${CALL} DEPENDS ${TOOL} ${ARG_PARAMS}
                     COMMENT "Parameters of the kernels of ${TARGET}" VERBATIM)
  file(GLOB DIALECT CONFIGURE_DEPENDS ${HOME}/dialect/*.h ${HOME}/dialect/glsl/* ${HOME}/dialect/opencl/*)
  set(INPUTS ${TOOL} ${HOME}/tools/check_bounds.py ${ARG_PARAMS} ${DIALECT})
  if(ARG_FUNCTIONS)
    cmake_path(ABSOLUTE_PATH ARG_FUNCTIONS)
    list(APPEND CALL --functions ${ARG_FUNCTIONS})
    list(APPEND INPUTS ${ARG_FUNCTIONS})
  endif()
  if(TOPPLE_CHECKED_KERNELS)
    list(APPEND CALL --checked ${CMAKE_CXX_COMPILER})
  endif()
  set(SOURCES)
  set(NATIVE_SOURCES)
  set(CHECKED_SOURCES)
  foreach(FILE IN LISTS ARG_KERNELS)
    cmake_path(ABSOLUTE_PATH FILE)
    cmake_path(GET FILE STEM LAST_ONLY NAME)
    set(MADE ${GENERATED}/${NAME})
    set(CHECKED_SOURCE)
    if(TOPPLE_CHECKED_KERNELS)
      set(CHECKED_SOURCE ${MADE}.checked.cpp)
    endif()
    add_custom_command(OUTPUT ${MADE}.hpp ${MADE}.source.cpp ${MADE}.native.cpp ${CHECKED_SOURCE}
                       COMMAND ${CALL} --kernel ${FILE} --glslang ${TOPPLE_GLSLANG}
                       DEPENDS ${FILE} ${INPUTS} COMMENT "Kernel ${NAME}" VERBATIM)
    list(APPEND HEADERS ${MADE}.hpp)
    list(APPEND SOURCES ${MADE}.source.cpp)
    list(APPEND NATIVE_SOURCES ${MADE}.native.cpp)
    list(APPEND CHECKED_SOURCES ${CHECKED_SOURCE})
  endforeach()
  add_custom_target(${TARGET}_kernel_sources DEPENDS ${HEADERS} ${SOURCES} ${NATIVE_SOURCES} ${CHECKED_SOURCES})
  add_dependencies(${TARGET} ${TARGET}_kernel_sources)
  target_sources(${TARGET} PRIVATE ${SOURCES})
  target_include_directories(${TARGET} PUBLIC $<BUILD_INTERFACE:${GENERATED}>)

  # Wider instruction sets are separate builds of the same kernels, chosen at run time; an unoptimised
  # build has none, so that its generic code can never come from a wider build's copy.
  set(ISAS baseline)
  set(OPTIMISE -O3)
  if("${TOPPLE_SANITIZE} ${CMAKE_CXX_FLAGS}" MATCHES "^[^ ]|-fsanitize")
    set(OPTIMISE -O2)  # kernels are what sanitized tests wait for
  elseif(CMAKE_BUILD_TYPE STREQUAL "Debug")
    set(OPTIMISE)
  elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND ISAS avx2 avx512)
    target_compile_definitions(${TARGET} PRIVATE TOPPLE_NATIVE_ISAS)
  endif()
  if(CHECKED_SOURCES)
    list(APPEND ISAS checked)
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${HOME}/tools/native_flags.txt)
  file(STRINGS ${HOME}/tools/native_flags.txt LINES REGEX "^[a-z]")
  foreach(LINE IN LISTS LINES)
    separate_arguments(FLAGS UNIX_COMMAND ${LINE})
    list(POP_FRONT FLAGS OF)
    set(FLAGS_${OF} ${FLAGS})
  endforeach()
  foreach(ISA IN LISTS ISAS)
    set(BUILT ${TARGET}_${ISA})
    if(ISA STREQUAL "checked")  # the last one
      set(NATIVE_SOURCES ${CHECKED_SOURCES})
    endif()
    add_library(${BUILT} OBJECT ${NATIVE_SOURCES})
    add_dependencies(${BUILT} ${TARGET}_kernel_sources)
    set_target_properties(${BUILT} PROPERTIES UNITY_BUILD OFF POSITION_INDEPENDENT_CODE ON)
    target_include_directories(${BUILT} SYSTEM PRIVATE ${HOME})
    target_link_libraries(${BUILT} PRIVATE topple::kernels)
    target_compile_definitions(${BUILT} PRIVATE TOPPLE_RUN_NAME=run_${ISA}
                                                $<$<BOOL:${TOPPLE_REVERSE_LANES}>:TOPPLE_REVERSE_LANES>)
    target_compile_options(${BUILT} PRIVATE ${OPTIMISE} ${FLAGS_all} $<$<CXX_COMPILER_ID:GNU>:${FLAGS_gcc}> ${FLAGS_${ISA}})
    target_sources(${TARGET} PRIVATE $<TARGET_OBJECTS:${BUILT}>)
    set_property(TARGET ${TARGET} APPEND PROPERTY TOPPLE_NATIVE ${BUILT})  # libraries of objects
  endforeach()
endfunction()
