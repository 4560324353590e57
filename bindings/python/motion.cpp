#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "arrays.hpp"
#include "module.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/constraint/support.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/scene/stepper.hpp"

namespace wunderlich::bindings {

namespace {

using constraint::Support;
using constraint::Surroundings;
using Numbers = std::array<double, 3>;

Vec3 vector(const Numbers& numbers) {
  const Vec3 vector{numbers[0], numbers[1], numbers[2]};
  if (!vector.allFinite()) throw py::value_error("a vector has a component that is no finite number");
  return vector;
}

/// A stepper, and its states as Python sees them: they change only while Python's lock is held.
class Motion {
 public:
  Motion(scene::Scene scene, const std::vector<const geometry::State*>& start) {
    std::vector<geometry::State> states;
    for (const geometry::State* state : start) {
      if (state == nullptr) throw py::type_error("start: None is no state");
      states.push_back(*state);
    }
    const py::gil_scoped_release others;
    stepper_.emplace(std::move(scene), std::move(states));
    states_ = stepper_->states();
  }

  bool step(double until) {
    return alone([&] { return stepper_->step(until); });
  }
  void reset() {
    alone([&] { return stepper_->reset(), true; });
  }
  void change(std::size_t strip, Surroundings surroundings) {
    alone([&] { return stepper_->change(strip, std::move(surroundings)), true; });
  }

  /// Nobody else may touch it while it computes.
  scene::Stepper& stepper() {
    if (busy_) throw std::runtime_error("this motion is taking a step in another thread");
    return *stepper_;
  }
  const std::vector<geometry::State>& states() const { return states_; }

 private:
  template <class Work>
  bool alone(const Work& work) {
    stepper();
    const struct Busy {
      explicit Busy(bool& on) : flag(on) { flag = true; }
      ~Busy() { flag = false; }
      bool& flag;
    } busy(busy_);
    bool done = false;
    {
      const py::gil_scoped_release others;
      done = work();
    }
    states_ = stepper_->states();  // of equal sizes, hence in place
    return done;
  }

  std::optional<scene::Stepper> stepper_;
  std::vector<geometry::State> states_;
  bool busy_ = false;  ///< read and written under Python's lock only
};

const scene::Scene& strip_of(Motion& motion, std::size_t strip) {
  const std::vector<const scene::Scene*> strips = strips_of(motion.stepper().scene());
  if (strip >= strips.size()) throw py::index_error("strip out of range");
  return *strips[strip];
}

template <class Change>
void change(Motion& motion, std::size_t strip, const Change& what) {
  Surroundings surroundings = strip_of(motion, strip).surroundings;
  what(surroundings);
  motion.change(strip, std::move(surroundings));
}

Support& support_of(Surroundings& surroundings, std::size_t support) {
  if (support >= surroundings.supports.size()) throw py::index_error("support out of range");
  return surroundings.supports[support];
}

void set_gravity(Motion& motion, const Numbers& gravity) {
  change(motion, 0, [&](Surroundings& s) { s.gravity = vector(gravity); });
}

/// `rotation` about the world's axes, then `turn` about the support's own tangent; what is not given stays.
void move(Motion& motion, std::size_t strip, std::size_t support, const std::optional<Numbers>& position,
          const Numbers& rotation, double turn, double until) {
  if (!std::isfinite(turn)) throw py::value_error("turn: not a finite number");
  const double now = motion.stepper().time();
  change(motion, strip, [&](Surroundings& s) {
    if (now >= support_of(s, support).release) throw py::value_error("support: it has let go");
    constraint::Motion& path = support_of(s, support).motion;
    constraint::PoseKey target{until, constraint::pose_at(path, now), turn};
    if (position) target.pose.position = vector(*position);
    target.pose.frame = (math::exp_map(vector(rotation)) * target.pose.frame).normalized();
    constraint::move_to(target, now, path);
  });
}

/// A pin at a node, where the node is.
std::size_t hold(Motion& motion, std::size_t strip, long node) {
  const double now = motion.stepper().time();
  const geometry::State& state = motion.states().at(strip);
  if (node < 0 || node >= static_cast<long>(state.r.size())) throw py::index_error("node out of range");
  std::size_t index = 0;
  change(motion, strip, [&](Surroundings& s) {
    Support pin;
    pin.node = static_cast<int>(node);
    pin.orientation = constraint::Orientation::free;
    pin.motion.keys = {{now, {state.r[static_cast<std::size_t>(node)], Quat::Identity()}, 0}};
    index = s.supports.size();
    s.supports.push_back(pin);
  });
  return index;
}

void release(Motion& motion, std::size_t strip, std::size_t support) {
  const double now = motion.stepper().time();
  change(motion, strip, [&](Surroundings& s) { support_of(s, support).release = now; });
}

py::list supports(Motion& motion, std::size_t strip) {
  const double now = motion.stepper().time();
  py::list out;
  for (const Support& support : strip_of(motion, strip).surroundings.supports) {
    const Pose pose = constraint::pose_at(support.motion, now);
    const char* kind = support.orientation == constraint::Orientation::full            ? "clamp"
                       : support.orientation == constraint::Orientation::about_tangent ? "about-tangent"
                                                                                       : "pin";
    const Vec3 tangent = pose.frame * Vec3::UnitZ(), normal = pose.frame * Vec3::UnitX();
    const auto numbers = [](const Vec3& v) { return py::make_tuple(v[0], v[1], v[2]); };
    py::dict entry(py::arg("kind") = kind, py::arg("node") = support.node, py::arg("holds") = now < support.release,
                   py::arg("position") = numbers(pose.position));
    if (support.orientation != constraint::Orientation::free) {
      entry["tangent"] = numbers(tangent), entry["normal"] = numbers(normal);
    }
    out.append(entry);
  }
  return out;
}

}  // namespace

void define_motion(py::module_& module) {
  py::class_<Motion>(module, "Motion")
      .def(py::init<scene::Scene, const std::vector<const geometry::State*>&>())
      .def("step", &Motion::step)
      .def("reset", &Motion::reset)
      .def_property_readonly("time", [](const Motion& m) { return m.states().front().time; })
      .def_property_readonly("failure", [](Motion& m) { return m.stepper().failure(); })
      .def_property_readonly("strips", [](const Motion& m) { return m.states().size(); })
      .def(
          "state", [](const Motion& m, std::size_t strip) -> const geometry::State& { return m.states().at(strip); },
          py::return_value_policy::reference_internal)
      .def("arrays",
           [](Motion& m, std::size_t strip) {
             return strip_arrays(m.stepper().scene(), {{m.states(), {}}}, strip);
           })
      .def("surface", [](Motion& m) { return surface_arrays(m.stepper().frame().surface); })
      .def("history", [](Motion& m) { return history_dict(m.stepper().history()); })
      .def_property(
          "gravity",
          [](Motion& m) {
            const Vec3& g = m.stepper().scene().surroundings.gravity;
            return py::make_tuple(g[0], g[1], g[2]);
          },
          &set_gravity)
      .def("supports", &supports)
      .def("move", &move)
      .def("hold", &hold)
      .def("release", &release);
}

}  // namespace wunderlich::bindings
