// The module tenebra._core: numpy arrays in and out of queries.h and of the program's renderer. What a user
// calls, with its checks of shapes and types, is in __init__.py; this is the thinnest way there.
#include <tenebra/visible_points.h>

#include "module_parts.h"

PYBIND11_MODULE(_core, module) {
  module.doc() = "What the package tenebra is made of; use that.";
  module.attr("version") = TENEBRA_VERSION;
  module.attr("no_triangle") = tenebra::no_triangle;
  tenebra::python::add_queries(module);
  tenebra::python::add_scenes(module);
  tenebra::python::add_suns(module);
}
