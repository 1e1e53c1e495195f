// The parts of the module tenebra._core.
#pragma once

#include <pybind11/pybind11.h>

namespace tenebra::python {

void add_queries(pybind11::module_& module);  ///< points and triangles of the caller's
void add_scenes(pybind11::module_& module);   ///< files, drawn
void add_suns(pybind11::module_& module);     ///< hours of sun, after the two above

}  // namespace tenebra::python
