/// What the page in the browser drives: one scene, on the way to its equilibrium or in motion, and a hand that pulls
/// it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/scene/run.hpp"
#include "wunderlich/scene/stepper.hpp"

namespace wunderlich::web {

/// What may be changed while the strip moves. Of several strips all are changed in the same proportion as the first.
struct Settings {
  double length = 0;            ///< [m]
  double width = 0;             ///< [m]
  double stiffness = 0;         ///< D [N m]
  double twist = 0;             ///< of the far end about its tangent, beyond what the scene asks for [rad]
  double damping = 0;           ///< rate at which velocities decay [1/s]
  Vec3 gravity = Vec3::Zero();  ///< [m/s^2]
};

/// How a hand holds a strip: by a support, which then goes where the hand goes, else by a spring on a segment.
struct Hand {
  std::size_t strip = 0;
  int support = -1;  ///< index; -1: none
  int segment = 0;
  Vec3 target = Vec3::Zero();     ///< where the held place is to go [m]
  double turn = 0;                ///< still to be turned about the tangent [rad]
  bool turned = false;            ///< does a spring hold the segment's frame as well
  Quat frame = Quat::Identity();  ///< if so, where
};

/// What has been shown, with the solids as they stood.
struct Film {
  std::vector<Frame> frames;
  std::vector<Body> bodies;
};

/// Equilibrium scenes run their path first and go on as motions, with damping, from where it ends; so does every scene
/// by the implicit method, whatever its own.
class Session {
 public:
  /// Throws InputError if the strip starts inside a solid, or has more segments than a page can move.
  explicit Session(scene::Scene scene);

  /// Is the path to the equilibrium still under way?
  bool on_path() const { return !motion_.has_value(); }
  /// Follows the path for about so many milliseconds. False when it is over.
  bool follow(double milliseconds);
  /// One step in time [s]. False if it failed: the strip stays in the last good state, what held it lets go, and what
  /// was pulled stands still. Where it succeeded `failure` is what could not be done beside it, if there was anything.
  bool step(double seconds);

  double time() const;                                     ///< of the motion [s]
  double pace() const { return pace_; }                    ///< seconds of the motion that are shown in one second
  double step_length() const { return step_; }             ///< longest step [s]
  const std::string& failure() const { return failure_; }  ///< why the path or the last step failed; empty
  /// The path or the last step failed for a reason from outside.
  void fail(const std::string& reason) { failure_ = reason; }
  /// Of the path when it is over.
  const std::optional<Summary>& summary() const { return summary_; }
  double share_done() const { return share_; }  ///< of the path
  const std::string& phase() const { return phase_; }

  const scene::Scene& scene() const { return motion_ ? motion_->scene() : scene_; }
  const std::vector<geometry::State>& states() const;
  HistoryRow history() const;
  Frame frame() const;
  /// The last seconds, or the path.
  Film film() const;

  const Settings& settings() const { return wanted_; }
  /// Takes effect within the next steps, little by little.
  void set(const Settings& settings);

  /// Takes hold of the strip at a node; nothing on the path.
  void grab(std::size_t strip, int node);
  void drag(const Vec3& target);
  void turn(double angle);
  void let_go();
  bool holds() const { return hand_.has_value(); }

 private:
  void start_motion(scene::Scene scene, std::vector<geometry::State> states);
  void go_live();
  template <class Edit>
  void remake(const Edit& edit);
  /// What a change of length, width and stiffness starts from.
  struct Form {
    Settings settings;
    std::vector<geometry::RibbonSpec> ribbons;
    std::vector<geometry::State> states;
  };
  Form form() const;
  bool reshapes() const;
  void reshape();
  void recover(const std::optional<Form>& before);
  void impose(double seconds);
  void move_hand(double seconds, constraint::Surroundings& surroundings);
  void twist_end(double seconds, constraint::Surroundings& surroundings);
  void keep_film();

  scene::Scene scene_;  ///< as given
  scene::Progress progress_;
  std::optional<scene::Stepper> motion_;
  std::optional<Summary> summary_;
  std::string failure_, phase_;
  double share_ = 0, pace_ = 1, step_ = 0.01, elapsed_ = 0;
  Settings given_, now_, wanted_;
  std::optional<Hand> hand_;
  std::optional<Quat> twisted_;  ///< where the frame of a free end is turned to, while it is
  std::vector<scene::Record> film_;
};

}  // namespace wunderlich::web
