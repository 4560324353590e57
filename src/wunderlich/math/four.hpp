/// Four doubles that are added and multiplied at once: three-vectors with a fourth entry to spare, or one number of
/// each of four nodes.
///
/// For the second use, formulas are templates on the number type, `double` or `Four`; what they need beside arithmetic
/// (roots, comparisons, functions taken lane by lane) exists for both.
///
/// With AVX the compiler's own vector of four; without it two vectors of two, because compilers split a vector of four
/// badly. The layout in memory is the same, so that code compiled either way can be linked.
#pragma once

#include <cmath>
#include <cstring>
#include <vector>

#include "wunderlich/base/types.hpp"

namespace wunderlich::math {

#ifdef __AVX__

using Four = double __attribute__((vector_size(32)));

inline Four all(double x) { return Four{x, x, x, x}; }

/// (y, z, x, w) and (z, x, y, w): the two turned copies in a cross product.
inline Four turn_left(Four a) { return __builtin_shufflevector(a, a, 1, 2, 0, 3); }
inline Four turn_right(Four a) { return __builtin_shufflevector(a, a, 2, 0, 1, 3); }

/// (y, x, w, z) and (z, w, x, y).
inline Four swap_pairs(Four a) { return __builtin_shufflevector(a, a, 1, 0, 3, 2); }
inline Four swap_halves(Four a) { return __builtin_shufflevector(a, a, 2, 3, 0, 1); }

/// Sums of the lanes of a, b and c, in the first three lanes.
inline Four lane_sums(Four a, Four b, Four c) {
  const Four ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cc = __builtin_shufflevector(c, c, 0, 0, 2, 2) + __builtin_shufflevector(c, c, 1, 1, 3, 3);
  return __builtin_shufflevector(ab, cc, 0, 1, 4, 5) + __builtin_shufflevector(ab, cc, 2, 3, 6, 7);
}

/// (a0 + a1, b0 + b1, a2 + a3, b2 + b3): half way to the sums of the lanes of a and b.
inline Four pair_sums(Four a, Four b) {
  return __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
}

/// (x, x, z, z), (y, y, w, w) and (x, x, w, w).
inline Four double_even(Four a) { return __builtin_shufflevector(a, a, 0, 0, 2, 2); }
inline Four double_odd(Four a) { return __builtin_shufflevector(a, a, 1, 1, 3, 3); }
inline Four double_ends(Four a) { return __builtin_shufflevector(a, a, 0, 0, 3, 3); }

/// Turns the rows a, b, c into columns; their fourth lanes are lost, those of the results are anything finite.
inline void transpose3(Four& a, Four& b, Four& c) {
  const Four low = __builtin_shufflevector(a, b, 0, 4, 2, 6), high = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  a = __builtin_shufflevector(low, c, 0, 1, 4, 4);
  b = __builtin_shufflevector(high, c, 0, 1, 5, 5);
  c = __builtin_shufflevector(low, c, 2, 3, 6, 6);
}

/// Turns the rows a, b, c, d into columns.
inline void transpose4(Four& a, Four& b, Four& c, Four& d) {
  const Four ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), ba = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd = __builtin_shufflevector(c, d, 0, 4, 2, 6), dc = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(ba, dc, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  d = __builtin_shufflevector(ba, dc, 2, 3, 6, 7);
}

/// (a1, a2, a3, b0): each lane moved on to the next, where b goes on where a ends.
inline Four moved_on(Four a, Four b) { return __builtin_shufflevector(a, b, 1, 2, 3, 4); }

#else

using Two = double __attribute__((vector_size(16)));

struct alignas(32) Four {
  Two low, high;
  Four() = default;
  constexpr Four(Two a, Two b) : low(a), high(b) {}
  constexpr Four(double x, double y, double z, double w) : low{x, y}, high{z, w} {}
  // Implicit, as the compiler's vectors take numbers.
  constexpr Four(double x) : low{x, x}, high{x, x} {}  // NOLINT(google-explicit-constructor)
  double operator[](int i) const { return i < 2 ? low[i] : high[i - 2]; }
  Four& operator+=(Four o) { return low += o.low, high += o.high, *this; }
  Four& operator-=(Four o) { return low -= o.low, high -= o.high, *this; }
};

inline Four operator+(Four a, Four b) { return {a.low + b.low, a.high + b.high}; }
inline Four operator-(Four a, Four b) { return {a.low - b.low, a.high - b.high}; }
inline Four operator-(Four a) { return {-a.low, -a.high}; }
inline Four operator*(Four a, Four b) { return {a.low * b.low, a.high * b.high}; }
inline Four operator/(Four a, Four b) { return {a.low / b.low, a.high / b.high}; }
inline Four all(double x) { return {Two{x, x}, Two{x, x}}; }

inline Four turn_left(Four a) {
  return {__builtin_shufflevector(a.low, a.high, 1, 2), __builtin_shufflevector(a.low, a.high, 0, 3)};
}
inline Four turn_right(Four a) {
  return {__builtin_shufflevector(a.low, a.high, 2, 0), __builtin_shufflevector(a.low, a.high, 1, 3)};
}

inline Four swap_pairs(Four a) {
  return {__builtin_shufflevector(a.low, a.low, 1, 0), __builtin_shufflevector(a.high, a.high, 1, 0)};
}
inline Four swap_halves(Four a) { return {a.high, a.low}; }

inline Four lane_sums(Four a, Four b, Four c) {
  const Two p = a.low + a.high, q = b.low + b.high, r = c.low + c.high;
  const Two pq = __builtin_shufflevector(p, q, 0, 2) + __builtin_shufflevector(p, q, 1, 3);
  return {pq, __builtin_shufflevector(r, r, 0, 0) + __builtin_shufflevector(r, r, 1, 1)};
}

inline Four pair_sums(Four a, Four b) {
  return {__builtin_shufflevector(a.low, b.low, 0, 2) + __builtin_shufflevector(a.low, b.low, 1, 3),
          __builtin_shufflevector(a.high, b.high, 0, 2) + __builtin_shufflevector(a.high, b.high, 1, 3)};
}

inline Two twice_first(Two a) { return __builtin_shufflevector(a, a, 0, 0); }
inline Two twice_second(Two a) { return __builtin_shufflevector(a, a, 1, 1); }
inline Four double_even(Four a) { return {twice_first(a.low), twice_first(a.high)}; }
inline Four double_odd(Four a) { return {twice_second(a.low), twice_second(a.high)}; }
inline Four double_ends(Four a) { return {twice_first(a.low), twice_second(a.high)}; }

inline void transpose3(Four& a, Four& b, Four& c) {
  const Four x{__builtin_shufflevector(a.low, b.low, 0, 2), __builtin_shufflevector(c.low, c.low, 0, 0)};
  const Four y{__builtin_shufflevector(a.low, b.low, 1, 3), __builtin_shufflevector(c.low, c.low, 1, 1)};
  c = {__builtin_shufflevector(a.high, b.high, 0, 2), __builtin_shufflevector(c.high, c.high, 0, 0)};
  a = x;
  b = y;
}

inline void transpose4(Four& a, Four& b, Four& c, Four& d) {
  const auto first = [](Two x, Two y) { return __builtin_shufflevector(x, y, 0, 2); };
  const auto second = [](Two x, Two y) { return __builtin_shufflevector(x, y, 1, 3); };
  const Four x{first(a.low, b.low), first(c.low, d.low)}, y{second(a.low, b.low), second(c.low, d.low)};
  const Four z{first(a.high, b.high), first(c.high, d.high)}, w{second(a.high, b.high), second(c.high, d.high)};
  a = x;
  b = y;
  c = z;
  d = w;
}

inline Four moved_on(Four a, Four b) {
  return {__builtin_shufflevector(a.low, a.high, 1, 2), __builtin_shufflevector(a.high, b.low, 1, 2)};
}

#endif

inline Four four(const Vec3& a, double fourth = 0) { return Four{a[0], a[1], a[2], fourth}; }
inline Four last_lane(double x) { return Four{0, 0, 0, x}; }
inline Vec3 first_three(Four a) { return {a[0], a[1], a[2]}; }

/// a x b in the first three lanes; the fourth is finite if those of a and b are, and 0 if they are.
inline Four cross(Four a, Four b) { return turn_left(a) * turn_right(b) - turn_right(a) * turn_left(b); }

/// a . b of the first three lanes.
inline double dot3(Four a, Four b) {
  const Four p = a * b;
  return p[0] + p[1] + p[2];
}

/// a . b
inline double dot4(Four a, Four b) {
  const Four p = a * b;
  return p[0] + p[1] + p[2] + p[3];
}

/// (f(a0), f(a1), f(a2), f(a3))
template <class Function>
Four by_lane(const Function& f, Four a) {
  return Four{f(a[0]), f(a[1]), f(a[2]), f(a[3])};
}

using std::cos;
using std::sin;
using std::sqrt;
inline Four sin(Four a) {
  return by_lane([](double x) { return std::sin(x); }, a);
}
inline Four cos(Four a) {
  return by_lane([](double x) { return std::cos(x); }, a);
}
inline Four sqrt(Four a) {
  return by_lane([](double x) { return std::sqrt(x); }, a);
}  // one instruction with AVX

/// Are all lanes below the bound? No where one is not a number.
inline bool all_below(double x, double bound) { return x < bound; }
inline bool all_below(Four a, double bound) { return a[0] < bound && a[1] < bound && a[2] < bound && a[3] < bound; }

/// Four entries from `first` on; beyond the end the last one.
inline Four load(const std::vector<double>& from, std::size_t first) {
  Four a;
  if (first + 4 <= from.size()) {
    std::memcpy(&a, from.data() + first, sizeof a);
    return a;
  }
  const auto at = [&](std::size_t i) { return i < from.size() ? from[i] : from.back(); };
  return Four{at(first), at(first + 1), at(first + 2), at(first + 3)};
}

inline void store(Four a, double* to) { std::memcpy(to, &a, sizeof a); }

}  // namespace wunderlich::math
