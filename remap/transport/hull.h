// SPDX-License-Identifier: LGPL-3.0-or-later
//
// Is a point in the convex hull of others, and how far does a ray stay in it?
// In N dimensions, N small, for vectors and tensors. Nothing depends on the
// frame: any linear change of the components changes points and hull alike.
//
// Closest points of the hull are found among few of the others (at most N + 1),
// which are exchanged one by one. @source Wolfe (1976), Finding the nearest
// point in a polytope; Gilbert, Johnson & Keerthi (1988) for the use of the
// normal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace remap::hull
{
template <int N>
using Vector = std::array<double, N>;

template <int N>
constexpr double dot(const Vector<N>& a, const Vector<N>& b)
{
  double sum = 0;
  for (int k = 0; k < N; ++k)
    sum += a[k] * b[k];
  return sum;
}

/// Point of a hull that is closest to a target.
///
/// @tparam Points callable: `visit(f)` calls f(const double*) for every point
template <int N, class Points>
class Nearest
{
public:
  explicit Nearest(const Points& points) : _points(points) {}

  /// From the target to the hull's nearest point; shorter than `close` counts
  /// as none. May end early with any vector `n` that separates, n · (p −
  /// target) > 0 for all p.
  /// @return is the target in the hull?
  bool inside(const Vector<N>& target, double close, Vector<N>& n)
  {
    _size = 0;
    Vector<N> x{};
    first(target, x);
    for (int step = 0; step < max_steps; ++step)
    {
      n = x;
      const double size2 = dot<N>(x, x);
      if (size2 <= close * close)
        return true;
      Vector<N> y{};
      const double ahead = support(target, x, y);
      // No point is nearer to the target's side: x is the nearest.
      if (size2 - ahead <= 1e-14 * size2 or not add(y, x))
        return dot<N>(x, x) <= close * close;
    }
    return false;
  }

private:
  static constexpr int max_steps = 40;
  static constexpr int room = N + 2;

  void first(const Vector<N>& target, Vector<N>& x)
  {
    double least = -1;
    _points(
        [&](const double* p)
        {
          Vector<N> y;
          for (int k = 0; k < N; ++k)
            y[k] = p[k] - target[k];
          const double size = dot<N>(y, y);
          if (least < 0 or size < least)
          {
            least = size;
            x = y;
          }
        });
    _y[0] = x;
    _weight[0] = 1;
    _size = 1;
  }

  /// Least x · (p − target) over all points, and that point from the target.
  double support(const Vector<N>& target, const Vector<N>& x, Vector<N>& y)
  {
    double least = 0;
    bool any = false;
    _points(
        [&](const double* p)
        {
          Vector<N> d;
          for (int k = 0; k < N; ++k)
            d[k] = p[k] - target[k];
          const double s = dot<N>(x, d);
          if (not any or s < least)
          {
            any = true;
            least = s;
            y = d;
          }
        });
    return least;
  }

  /// Take a point in, drop those that do not help; x becomes the nearest point
  /// of those that stay. False if that is not nearer.
  bool add(const Vector<N>& y, Vector<N>& x)
  {
    const double before = dot<N>(x, x);
    if (_size == room)
      return false;
    _y[_size] = y;
    _weight[_size] = 0;
    ++_size;
    while (true)
    {
      std::array<double, room> w{};
      if (not affine(w))
        return false;
      int worst = -1;
      double part = 1;
      for (int i = 0; i < _size; ++i)
        if (w[i] <= 0 and _weight[i] - w[i] > 0)
          if (const double t = _weight[i] / (_weight[i] - w[i]);
              worst < 0 or t < part)
          {
            part = t;
            worst = i;
          }
      for (int i = 0; i < _size; ++i)
        _weight[i] += (worst < 0 ? 1 : part) * (w[i] - _weight[i]);
      if (worst < 0)
        break;
      drop(worst);
      if (_size == 1)
      {
        _weight[0] = 1;
        break;
      }
    }
    x = {};
    for (int i = 0; i < _size; ++i)
      for (int k = 0; k < N; ++k)
        x[k] += _weight[i] * _y[i][k];
    return dot<N>(x, x) < before;
  }

  void drop(int i)
  {
    --_size;
    _y[i] = _y[_size];
    _weight[i] = _weight[_size];
  }

  /// Weights, not all positive, of the nearest point of the plane through the
  /// points kept: the minimum of |Σ w y|² with Σ w = 1. False if the points lie
  /// on a smaller plane.
  bool affine(std::array<double, room>& w) const
  {
    // The least |last + Σ v e| over edges e from the last point, by
    // orthogonalisation: products of edges would lose half the digits, and
    // hulls can be thin.
    const int m = _size - 1;
    std::array<Vector<N>, room> q;
    std::array<std::array<double, room>, room> r;
    std::array<double, room> b;
    const Vector<N>& last = _y[m];
    Vector<N> rest;
    for (int k = 0; k < N; ++k)
      rest[k] = -last[k];
    for (int j = 0; j < m; ++j)
    {
      for (int k = 0; k < N; ++k)
        q[j][k] = _y[j][k] - last[k];
      const double full = dot<N>(q[j], q[j]);
      for (int i = 0; i < j; ++i)
      {
        r[i][j] = dot<N>(q[i], q[j]);
        for (int k = 0; k < N; ++k)
          q[j][k] -= r[i][j] * q[i][k];
      }
      const double left = dot<N>(q[j], q[j]);
      if (not(left > 1e-26 * full))
        return false;
      r[j][j] = std::sqrt(left);
      for (int k = 0; k < N; ++k)
        q[j][k] /= r[j][j];
      b[j] = dot<N>(q[j], rest);
      for (int k = 0; k < N; ++k)
        rest[k] -= b[j] * q[j][k];
    }
    double sum = 0;
    for (int i = m - 1; i >= 0; --i)
    {
      for (int k = i + 1; k < m; ++k)
        b[i] -= r[i][k] * w[k];
      w[i] = b[i] / r[i][i];
      sum += w[i];
    }
    w[m] = 1 - sum;
    return true;
  }

  const Points& _points;
  int _size = 0;
  std::array<Vector<N>, room> _y;
  std::array<double, room> _weight{};
};

/// Largest t in [0, 1] for which from + t · way lies in the hull, to within
/// `close`; 0 if `from` is outside.
template <int N, class Points>
double reach(const Points& points, const Vector<N>& from, const Vector<N>& way,
             double close)
{
  Nearest<N, Points> nearest(points);
  double t = 1;
  double less = 1e-12;
  for (int cut = 0; cut < 20; ++cut, less *= 4)
  {
    Vector<N> target, n;
    for (int k = 0; k < N; ++k)
      target[k] = from[k] + t * way[k];
    if (nearest.inside(target, close, n))
      return t;
    // The hull lies beyond the plane across n through its own support.
    double support = 0;
    bool first = true;
    points(
        [&](const double* p)
        {
          double s = 0;
          for (int k = 0; k < N; ++k)
            s += n[k] * p[k];
          support = first ? s : std::min(support, s);
          first = false;
        });
    const double along = dot<N>(n, way);
    const double room = dot<N>(n, from) - support;
    // Where round-off hides the plane, try half the way.
    const double next = along < 0 and room > 0 ? room / -along : 0.5 * t;
    // A little less, and more each time, or round-off could hold the last place
    // outside.
    t = std::min(next, t) * (1 - less);
  }
  return 0;
}
} // namespace remap::hull
