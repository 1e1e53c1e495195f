# The OpenGL loader: glad 2, generated at build time for core 4.5 (package python3-glad). --reproducible: from the
# specification in that package, else it fetches the latest from the network.
set(glad_dir ${CMAKE_BINARY_DIR}/glad)
set(glad_header ${glad_dir}/include/glad/gl.h)
add_custom_command(
  OUTPUT ${glad_header}
  COMMAND glad --reproducible --quiet --api gl:core=4.5 --extensions GL_KHR_debug --out-path ${glad_dir} c --header-only
  COMMENT "Generating the OpenGL loader" VERBATIM)
add_custom_target(tenebra_glad_generate DEPENDS ${glad_header})
add_library(tenebra_glad INTERFACE)
target_include_directories(tenebra_glad SYSTEM INTERFACE ${glad_dir}/include)
add_dependencies(tenebra_glad tenebra_glad_generate)
