#include "module.hpp"

#include <pybind11/stl.h>

#include "arrays.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/base/version.hpp"
#include "wunderlich/scene/read.hpp"

namespace wunderlich::bindings {

namespace {

using scene::Scene;

/// The scene of a text, under a name that need not be a file's.
Scene scene_of(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
  Scene scene = scene::read_scene_text(text, name, overrides);
  for (Scene& strip : scene.beside) strip.name = name;
  scene.name = name;
  return scene;
}

py::list ribbons(const Scene& scene) {
  py::list out;
  for (const Scene* strip : strips_of(scene)) {
    const geometry::RibbonSpec& r = strip->ribbon;
    out.append(py::dict(py::arg("name") = strip->ribbon_name, py::arg("length") = r.length, py::arg("width") = r.width,
                        py::arg("segments") = r.segments, py::arg("bending_stiffness") = r.bending_stiffness,
                        py::arg("area_density") = r.area_density,
                        py::arg("loop") = r.closure == geometry::Closure::loop,
                        py::arg("half_twists") = r.half_twists));
  }
  return out;
}

py::list shipped_names() {
  py::list out;
  for (const scene::ShippedScene& shipped : scene::shipped_scenes()) out.append(shipped.name);
  return out;
}

template <class Member>
auto view_of(Member member) {
  return [member](const py::object& self) { return view(py::cast<const geometry::State&>(self).*member, self); };
}

}  // namespace

void define_scene(py::module_& module) {
  py::class_<Scene>(module, "Scene")
      .def_readonly("name", &Scene::name)
      .def_readonly("title", &Scene::title)
      .def_readonly("text", &Scene::resolved)
      .def_property_readonly("method", [](const Scene& s) { return scene::method_name(s.solver.method); })
      .def_property_readonly("duration", [](const Scene& s) { return s.solver.duration; })
      .def_property_readonly("time_step", [](const Scene& s) { return s.solver.time_step; })
      .def_property_readonly("ribbons", &ribbons)
      .def(py::pickle([](const Scene& s) { return py::make_tuple(s.resolved, s.name); },
                      [](const py::tuple& kept) {
                        return scene_of(kept[0].cast<std::string>(), kept[1].cast<std::string>(), {});
                      }));
  module.def("read_scene", &scene::read_scene);
  module.def("scene_of", &scene_of);
  module.def("shipped_names", &shipped_names);
}

void define_state(py::module_& module) {
  using geometry::State;
  py::class_<State>(module, "State",
                    "A strip of n segments at one time. The arrays are read-only views of the library's own memory.")
      .def_readonly("time", &State::time, "Time [s]; of an equilibrium path the load parameter.")
      .def_property_readonly("r", view_of(&State::r), "(n + 1, 3) positions of the nodes [m].")
      .def_property_readonly("r_dot", view_of(&State::r_dot), "(n + 1, 3) velocities of the nodes [m/s].")
      .def_property_readonly("q", view_of(&State::q), "(n, 4) unit quaternions x, y, z, w of the segments' frames.")
      .def_property_readonly("eta", view_of(&State::eta), "(n + 1) slopes of the rulings, ruling = d2 + eta d3.");
}

}  // namespace wunderlich::bindings

PYBIND11_MODULE(_wunderlich, module) {
  using namespace wunderlich::bindings;
  module.attr("__version__") = wunderlich::version;
  auto& error = py::register_exception<wunderlich::InputError>(module, "InputError", PyExc_ValueError);
  error.attr("__module__") = "wunderlich";
  error.doc() = "Bad input. The message says where it stands, the key, its value and what would be right.";
  define_scene(module);
  define_state(module);
  define_run(module);
  define_motion(module);
}
