/// The parts of the module `_wunderlich`: scenes, runs and motions as the C++ library has them. What users see, with
/// its documentation, is the package in python/wunderlich.
#pragma once

#include <pybind11/pybind11.h>

namespace wunderlich::bindings {

void define_scene(pybind11::module_& module);
void define_state(pybind11::module_& module);
void define_run(pybind11::module_& module);
void define_motion(pybind11::module_& module);

}  // namespace wunderlich::bindings
