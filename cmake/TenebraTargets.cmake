# tenebra_library(NAME ...): the library tenebra_NAME from src/NAME, linked to what follows
# (arguments as target_link_libraries takes them). A folder without .cpp files is header-only.
function(tenebra_library name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${name}/*.cpp)
  if(sources)
    add_library(tenebra_${name} STATIC ${sources})
    target_include_directories(tenebra_${name} PUBLIC
      $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include> $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src>
      $<INSTALL_INTERFACE:include>)
    target_link_libraries(tenebra_${name} ${ARGN})
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
