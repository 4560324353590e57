// What JavaScript sees: plain functions, one session, and arrays that it reads where they lie in memory.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "session.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/constraint/support.hpp"
#include "wunderlich/energy/width_factor.hpp"
#include "wunderlich/io/glb.hpp"
#include "wunderlich/io/summary_json.hpp"
#include "wunderlich/io/svg.hpp"
#include "wunderlich/scene/read.hpp"

namespace {

using namespace wunderlich;
using nlohmann::json;

/// What is drawn, as three.js takes it. Rows of several strips follow one another.
struct View {
  std::vector<float> points, normals, u, rulings;  ///< of the mesh; rulings: both ends at each node
  std::vector<std::uint32_t> triangles;
  std::vector<float> nodes;                               ///< positions
  std::array<std::vector<float>, 5> fields;               ///< of nodes: u, kappa, tau, eta, energy a length
  std::vector<float> body_points, body_normals, poses;    ///< poses: x, y, z and quaternion x, y, z, w
  std::vector<std::uint32_t> body_triangles, body_sizes;  ///< of each body: points, triangles
  std::vector<double> numbers;
};

std::unique_ptr<web::Session> session;
View view;
std::string input, answer;

void add(const Vec3& v, std::vector<float>& out) {
  for (int c = 0; c < 3; ++c) out.push_back(static_cast<float>(v[c]));
}

/// Energy a length of the strip at a node.   @eq Shen2015:3
double energy_density(const geometry::RibbonSpec& ribbon, const energy::Model& model, const CenterlineSample& node) {
  const double bending = node.kappa * (1 + node.eta * node.eta);
  const double x = std::clamp(0.5 * ribbon.width * node.eta_prime, -0.999, 0.999);
  return 0.5 * ribbon.bending_stiffness * ribbon.width * bending * bending * energy::width_factor(model, x).value;
}

void view_bodies(const scene::Scene& scene) {
  view.body_points.clear(), view.body_normals.clear(), view.body_triangles.clear(), view.body_sizes.clear();
  for (const Body& body : scene::bodies_of(scene, {})) {
    for (const Vec3& p : body.mesh.points) add(p, view.body_points);
    for (const Vec3& n : body.mesh.normals) add(n, view.body_normals);
    for (const auto& t : body.mesh.triangles) {
      for (const int i : t) view.body_triangles.push_back(static_cast<std::uint32_t>(i));
    }
    view.body_sizes.push_back(static_cast<std::uint32_t>(body.mesh.points.size()));
    view.body_sizes.push_back(static_cast<std::uint32_t>(body.mesh.triangles.size()));
  }
}

void view_poses() {
  const scene::Scene& scene = session->scene();
  const double time = session->states().front().time;
  view.poses.clear();
  for (const constraint::Obstacle& obstacle : scene.surroundings.obstacles) {
    const Pose pose = constraint::pose_at(obstacle.motion, time);
    add(pose.position, view.poses);
    for (int c = 0; c < 4; ++c) view.poses.push_back(static_cast<float>(pose.frame.coeffs()[c]));
  }
}

void view_mesh(const Mesh& mesh) {
  view.points.clear(), view.normals.clear(), view.u.clear();
  for (const Vec3& p : mesh.points) add(p, view.points);
  for (const Vec3& n : mesh.normals) add(n, view.normals);
  for (const double u : mesh.fields.front().values) view.u.push_back(static_cast<float>(u));
  if (view.triangles.size() == 3 * mesh.triangles.size()) return;
  view.triangles.clear();
  for (const auto& t : mesh.triangles) {
    for (const int i : t) view.triangles.push_back(static_cast<std::uint32_t>(i));
  }
}

void view_nodes(const std::vector<CenterlineSample>& line) {
  const std::vector<const scene::Scene*> strips = scene::strips_of(session->scene());
  view.rulings.clear(), view.nodes.clear();
  for (auto& field : view.fields) field.clear();
  for (const CenterlineSample& node : line) {
    const scene::Scene& strip = *strips[static_cast<std::size_t>(node.ribbon)];
    const Vec3 half = 0.5 * strip.ribbon.width * (node.d2 + node.eta * node.d3);
    add(node.r - half, view.rulings), add(node.r + half, view.rulings);
    add(node.r, view.nodes);
    const std::array<double, 5> values{node.u, node.kappa, node.tau, node.eta,
                                       energy_density(strip.ribbon, strip.solver.energy, node)};
    for (std::size_t i = 0; i < values.size(); ++i) view.fields[i].push_back(static_cast<float>(values[i]));
  }
}

void view_numbers() {
  const HistoryRow row = session->history();
  const web::Settings& s = session->settings();
  view.numbers = {session->time(),
                  row.energy.elastic,
                  row.energy.kinetic,
                  row.energy.gravity,
                  row.energy.normalized,
                  row.area_error,
                  row.constraints.max_torsion_mismatch,
                  row.constraints.max_ruling_ratio,
                  static_cast<double>(row.iterations),
                  row.step_us,
                  session->share_done(),
                  s.length,
                  s.width,
                  s.stiffness,
                  s.twist,
                  s.damping,
                  s.gravity[0],
                  s.gravity[1],
                  s.gravity[2]};
}

void refresh() {
  const Frame frame = session->frame();
  view_mesh(frame.surface);
  view_nodes(frame.centerline);
  view_poses();
  view_numbers();
}

json strip_json(const scene::Scene& strip) {
  const geometry::RibbonSpec& r = strip.ribbon;
  const bool loop = r.closure == geometry::Closure::loop;
  json out{{"segments", r.segments}, {"length", r.length},           {"width", r.width},
           {"loop", loop},           {"half_twists", r.half_twists}, {"name", strip.ribbon_name}};
  json held = json::array();
  for (const constraint::Support& support : strip.surroundings.supports) held.push_back(support.node);
  out["supports"] = held;
  return out;
}

void describe(const scene::Scene& scene) {
  json out{{"name", scene.name},
           {"title", scene.title},
           {"text", scene.written},
           {"resolved", scene.resolved},
           {"on_path", session->on_path()},
           {"pace", session->pace()},
           {"step", session->step_length()},
           {"failure", session->failure()}};
  for (const scene::Scene* strip : scene::strips_of(scene)) out["strips"].push_back(strip_json(*strip));
  answer = out.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Calls; an InputError becomes the answer, and the result false.
template <class Call>
bool guarded(const Call& call) {
  try {
    call();
    return true;
  } catch (const InputError& error) {
    answer = error.what();
  } catch (const std::exception& error) {
    answer = std::string("this should not happen: ") + error.what();
  }
  return false;
}

/// The same of a call whose failure `wl_failure` gives.
template <class Call>
bool guarded_step(const Call& call) {
  if (guarded(call)) return true;
  session->fail(answer);
  return false;
}

}  // namespace

#define EXPORT extern "C" __attribute__((used, visibility("default")))

/// Room for so many bytes of text that the next call reads.
EXPORT char* wl_input(int size) {
  input.resize(static_cast<std::size_t>(size));
  return input.data();
}
EXPORT const char* wl_answer() { return answer.data(); }
EXPORT int wl_answer_size() { return static_cast<int>(answer.size()); }

/// The shipped scenes: [{name, title, text}].
EXPORT void wl_scenes() {
  json out = json::array();
  for (const scene::ShippedScene& shipped : scene::shipped_scenes()) {
    const std::size_t at = shipped.text.find("\ntitle:");
    const std::string rest = at == std::string::npos ? "" : shipped.text.substr(at + 7);
    const std::string title = rest.substr(0, rest.find('\n'));
    const std::size_t first = title.find_first_not_of(" \"'");
    out.push_back({{"name", shipped.name},
                   {"text", shipped.text},
                   {"title", first == std::string::npos ? "" : title.substr(first)}});
  }
  answer = out.dump();
}

/// Reads the scene in the input, a JSON object {text, name, overrides}, and starts it: the answer describes it. 0: the
/// answer is the reader's message, and the session before goes on.
EXPORT int wl_load() {
  return guarded([] {
    const json in = json::parse(input);
    scene::Scene scene = scene::read_scene_text(in.at("text").get<std::string>(), in.at("name").get<std::string>(),
                                                in.at("overrides").get<std::vector<std::string>>());
    auto next = std::make_unique<web::Session>(scene);
    session = std::move(next);
    view = {};
    view_bodies(session->scene());
    refresh();
    describe(scene);
  });
}

/// Only reads the same input: the answer is the scene with its overrides written out, or the message.
EXPORT int wl_resolve() {
  return guarded([] {
    const json in = json::parse(input);
    answer = scene::read_scene_text(in.at("text").get<std::string>(), in.at("name").get<std::string>(),
                                    in.at("overrides").get<std::vector<std::string>>())
                 .resolved;
  });
}

/// Is the session on the path to its equilibrium?
EXPORT int wl_on_path() { return session->on_path() ? 1 : 0; }
/// Follows it for some milliseconds. 0: over, or it failed; see wl_failure.
EXPORT int wl_follow(double milliseconds) {
  bool more = false;
  const bool done = guarded_step([&] { more = session->follow(milliseconds); });
  return done && more ? 1 : 0;
}
/// One step [s]. 0: it failed, 2: it went well, but something else could not be done; see wl_failure.
EXPORT int wl_step(double seconds) {
  bool taken = false;
  if (!guarded_step([&] { taken = session->step(seconds); }) || !taken) return 0;
  return session->failure().empty() ? 1 : 2;
}
/// Why the last step or the path failed: the answer.
EXPORT void wl_failure() { answer = session->failure(); }
EXPORT void wl_phase() { answer = session->phase(); }
/// Of the path when it is over: the answer is what the program writes as summary.json.
EXPORT int wl_summary() {
  return guarded([] {
    if (!session->summary()) throw InputError("the path is not over");
    answer = io::summary_json(*session->summary());
  });
}
/// 0: what there is cannot be drawn; the answer says why.
EXPORT int wl_refresh() { return guarded(refresh); }

EXPORT int wl_set(double length, double width, double stiffness, double twist, double damping, double gx, double gy,
                  double gz) {
  return guarded([&] { session->set({length, width, stiffness, twist, damping, Vec3(gx, gy, gz)}); });
}
EXPORT void wl_grab(int strip, int node) { session->grab(static_cast<std::size_t>(strip), node); }
EXPORT void wl_drag(double x, double y, double z) { session->drag(Vec3(x, y, z)); }
EXPORT void wl_turn(double angle) { session->turn(angle); }
EXPORT void wl_let_go() { session->let_go(); }
EXPORT int wl_holds() { return session->holds() ? 1 : 0; }

/// Arrays of the last refresh, in the order of `View`: where they lie and how many numbers they hold.
EXPORT const void* wl_array(int which) {
  const std::array<const void*, 17> all{view.points.data(),       view.normals.data(),   view.u.data(),
                                        view.rulings.data(),      view.triangles.data(), view.nodes.data(),
                                        view.fields[0].data(),    view.fields[1].data(), view.fields[2].data(),
                                        view.fields[3].data(),    view.fields[4].data(), view.body_points.data(),
                                        view.body_normals.data(), view.poses.data(),     view.body_triangles.data(),
                                        view.body_sizes.data(),   view.numbers.data()};
  return all.at(static_cast<std::size_t>(which));
}
EXPORT int wl_array_size(int which) {
  const std::array<std::size_t, 17> all{view.points.size(),       view.normals.size(),   view.u.size(),
                                        view.rulings.size(),      view.triangles.size(), view.nodes.size(),
                                        view.fields[0].size(),    view.fields[1].size(), view.fields[2].size(),
                                        view.fields[3].size(),    view.fields[4].size(), view.body_points.size(),
                                        view.body_normals.size(), view.poses.size(),     view.body_triangles.size(),
                                        view.body_sizes.size(),   view.numbers.size()};
  return static_cast<int>(all.at(static_cast<std::size_t>(which)));
}

/// The answer: the animated surface and the obstacles as a GLB file, or the first strip's pattern as SVG.
EXPORT int wl_glb() {
  return guarded([] {
    const web::Film film = session->film();
    answer = io::glb(film.frames, film.bodies, session->scene().name);
  });
}
EXPORT int wl_pattern() {
  return guarded([] {
    const scene::Scene& scene = session->scene();
    const std::vector<FlatPattern> patterns = scene::patterns_of(scene, {session->states(), {}});
    answer = io::pattern_svg(patterns.front(), scene.title);
  });
}
