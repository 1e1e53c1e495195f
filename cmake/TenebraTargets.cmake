# tenebra_library(NAME ...): the library tenebra_NAME from src/NAME, linked to what follows
# (arguments as target_link_libraries takes them). A folder without .cpp files is header-only.
# Folders of TENEBRA_ROOMS_APART, as io/exr, are no part of the folder above: tenebra_library(io/exr) makes tenebra_io_exr.
function(tenebra_library folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${folder}/*.cpp)
  foreach(room ${TENEBRA_ROOMS_APART})
    if(NOT room STREQUAL folder)
      list(FILTER sources EXCLUDE REGEX "/src/${room}/")
    endif()
  endforeach()
  string(REPLACE "/" "_" name ${folder})
  if(sources)
    add_library(tenebra_${name} STATIC ${sources})
    target_include_directories(tenebra_${name} PUBLIC
      $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include> $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src>
      $<INSTALL_INTERFACE:include>)
    target_link_libraries(tenebra_${name} ${ARGN})
    # glad's functions are defined in one file of gl, and declared in the others.
    if(NOT name STREQUAL gl)
      tenebra_unite(tenebra_${name})
    endif()
  else()
    add_library(tenebra_${name} INTERFACE)
    target_include_directories(tenebra_${name} INTERFACE
      $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include> $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src>
      $<INSTALL_INTERFACE:include>)
    set(links ${ARGN})
    list(REMOVE_ITEM links PUBLIC PRIVATE)
    target_link_libraries(tenebra_${name} INTERFACE ${links})
  endif()
  set_target_properties(tenebra_${name} PROPERTIES EXPORT_NAME ${name})
endfunction()

# tenebra_unite(TARGET): with TENEBRA_UNITY the files of each folder are compiled together, as most of the time goes into
# the standard library's headers. Those that Highway includes once for each vector level stay alone, as do those with
# options of their own.
function(tenebra_unite target)
  if(NOT TENEBRA_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    file(STRINGS ${source} once_a_level REGEX "foreach_target\\.h" LIMIT_COUNT 1)
    if(NOT once_a_level)
      get_filename_component(folder ${source} DIRECTORY)
      file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${folder})
      string(MAKE_C_IDENTIFIER "${folder}" group)
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${group})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # Types in unnamed namespaces may be members here: each group is one file that nobody includes.
  target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
endfunction()
