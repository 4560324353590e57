// A step allocates nothing once its buffers have their size. Counts every allocation of this program.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "implicit/motions.hpp"
#include "solver/paths.hpp"
#include "wunderlich/math/four.hpp"

namespace {
std::atomic<long> allocations{0};

void* or_throw(void* p) {
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
}  // namespace

// The linker turns every malloc of this program's own objects, Eigen's included, into this one.
extern "C" {
void* __real_malloc(std::size_t size);   // NOLINT
void* __wrap_malloc(std::size_t size) {  // NOLINT
  ++allocations;
  return __real_malloc(size);
}
}

void* operator new(std::size_t size) { return or_throw(std::malloc(size > 0 ? size : 1)); }
void* operator new[](std::size_t size) { return or_throw(std::malloc(size > 0 ? size : 1)); }
void* operator new(std::size_t size, std::align_val_t align) {
  ++allocations;
  const auto a = static_cast<std::size_t>(align);
  return or_throw(std::aligned_alloc(a, (size + a - 1) / a * a));
}
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // once new is inlined: both are malloc and free
#endif
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace wunderlich::testing {
namespace {

/// What steps that are accepted at once allocate after the first few. (A step that is not says why, in a string.)
void expect_none(double dt, Motion& m) {
  const double t = m.state.strips[0].path.t;
  for (int i = 1; i <= 10; ++i) ASSERT_TRUE(move_to(t + dt * i, m)) << m.failure;
  int at_once = 0;
  long made = 0;
  for (int i = 11; i <= 60; ++i) {
    const long before = allocations;
    const int halvings = m.halvings;
    ASSERT_TRUE(move_to(t + dt * i, m)) << m.failure;
    if (m.halvings != halvings) continue;
    made += allocations - before;
    ++at_once;
  }
  EXPECT_GE(at_once, 40);
  EXPECT_EQ(made, 0);
}

TEST(Allocation, TheCounterCounts) {
  const long before = allocations;
  std::vector<double> list(100, 1.0);
  std::vector<math::Four> aligned(100);
  Eigen::VectorXd matrix = Eigen::VectorXd::Constant(100, list[3]);
  aligned[3] = math::all(matrix[3]);
  EXPECT_EQ(allocations - before, 3) << aligned[3][0];
}

TEST(Allocation, NoneInStepsOfASwing) {
  for (const auto kinetic :
       {implicit::KineticEnergy::centerline, implicit::KineticEnergy::rotary, implicit::KineticEnergy::full}) {
    Motion m = swing(1e-2, 0.3);
    m.options.kinetic = kinetic;
    m.options.viscosity = 1e-3;
    m.options.drag_normal = 1;
    start(m);
    expect_none(1e-3, m);
    m.options.viscosity = m.options.drag_normal = 0;
    m.options.conserve = true;
    start(m);
    expect_none(1e-3, m);
  }
}

TEST(Allocation, NoneInStepsOfAStripHeldAtBothEnds) {
  Motion m = between_clamps();
  expect_none(2e-3, m);
}

TEST(Allocation, NoneInStepsOfALoop) {
  const PathEnd rest = moebius(30, 0.4, 1e-3);
  Motion m;
  m.path = rest.path;
  geometry::State shape = rest.shape;
  shape.time = 0;
  for (std::size_t i = 0; i < shape.r.size(); ++i)
    shape.r_dot[i] = 0.3 * Vec3(std::cos(0.4 * static_cast<double>(i)), 0, 1);
  shape.r_dot.back() = shape.r_dot.front();
  start(shape, Vec3::Zero(), m);
  expect_none(1e-2, m);
}

}  // namespace
}  // namespace wunderlich::testing
