// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The closure of two bonded layers. Unknowns are the jump of strain a and the
// mean theta' of the volume strains; strains of the layers A and B, of
// fractions phi at the start, are
//
//     de + theta' I / 3 + phi_B N a,    de + theta' I / 3 - phi_A N a,
//
// N a = sym(a x n), a by its parts along the normal and across. They leave the
// traction N^T (sigma_A - sigma_B) = 0 and the pressure w_A p_A + w_B p_B = p,
// w the volumes at the end.
#include "closure.h"
#include "parallel.h"

#include <Eigen/LU>
#include <cassert>

namespace mmale::material
{
namespace
{
/// s, p and flow in one.
using Six = Eigen::Vector<double, 6>;
using Jump = Eigen::Matrix<double, 4, 2>;
constexpr int at_p = 4, at_flow = 5;
/// Jump along the normal, across, and the volume strain.
using Unknowns = Eigen::Vector3d;

const Voigt one(1, 1, 1, 0);

/// A layer: its answer at a state of the unknowns, and derivatives.
struct Layer
{
  Parallel material;
  double reach;    ///< of the jump in it: phi_B or -phi_A
  double fraction; ///< of both at the start

  Response r = {};
  double theta = 0;
  double weight = 0; ///< its part of the volume at the end

  Strain strain(const Voigt& de, const Unknowns& x, const Jump& N,
                double dt) const
  {
    const Voigt jump = reach * (N * x.head<2>());
    const double opening = jump.head<3>().sum();
    return {de + jump - opening / 3 * one, x[2] + opening, dt};
  }

  Six value() const
  {
    Six y;
    y << r.s, r.p, r.flow;
    return y;
  }
  Eigen::Matrix<double, 6, 4> by_de() const
  {
    Eigen::Matrix<double, 6, 4> d;
    d << r.ds_de, r.dp_de.transpose(), r.dflow_de.transpose();
    return d;
  }
  Six by_theta() const
  {
    Six d;
    d << r.ds_dtheta, r.dp_dtheta, r.dflow_dtheta;
    return d;
  }
  /// By the jump and the volume strain; of the layer's own volume strain by
  /// them `opening`.
  Eigen::Matrix<double, 6, 3> by_unknowns(const Jump& N) const
  {
    const Eigen::RowVector2d trace = N.topRows<3>().colwise().sum();
    const Jump deviator = N - one / 3 * trace;
    Eigen::Matrix<double, 6, 3> d;
    d << reach * (by_de() * deviator + by_theta() * trace), by_theta();
    return d;
  }
  Eigen::RowVector3d opening(const Jump& N) const
  {
    const Eigen::RowVector2d trace = N.topRows<3>().colwise().sum();
    return {reach * trace[0], reach * trace[1], 1};
  }
};

class Layers
{
public:
  Layers(std::span<Share> shares, const Voigt& de, double p, double dt,
         const Interface& interface)
      : _layers{Layer{Parallel(shares, Parallel::Of::one, interface.first), 0,
                      0},
                Layer{Parallel(shares, Parallel::Of::others, interface.first),
                      0, 0}},
        _de(de), _p(p), _dt(dt)
  {
    const auto [x, y] = interface.normal;
    _N << x * x, -x * y, y * y, x * y, 0, 0, 2 * x * y, x * x - y * y;
    auto& [a, b] = _layers;
    const double sum = a.material.fraction() + b.material.fraction();
    a.fraction = a.material.fraction() / sum;
    b.fraction = b.material.fraction() / sum;
    a.reach = b.fraction;
    b.reach = -a.fraction;
  }

  /// Residuals and their slopes at x, with the laws' answers left behind.
  Outcome evaluate(const Unknowns& x, TangentKind kind)
  {
    refused = -1;
    double growth = 0;
    for (Layer& layer : _layers)
    {
      const Strain strain = layer.strain(_de, x, _N, _dt);
      if (layer.material.update({}, strain, kind, {}, layer.r) != Outcome::ok)
      {
        refused = layer.material.refused;
        return Outcome::reduce_step;
      }
      layer.theta = strain.theta;
      growth += layer.fraction * std::expm1(strain.theta);
    }
    for (Layer& layer : _layers)
      layer.weight = layer.fraction * std::exp(layer.theta) / (1 + growth);
    assemble();
    return _residual.allFinite() and _slope.allFinite() ? Outcome::ok
                                                        : Outcome::reduce_step;
  }

  /// Unknowns of two elastic layers.
  Unknowns elastic()
  {
    for (Layer& layer : _layers)
    {
      const auto [G, K] = layer.material.moduli({}, _dt);
      layer.r = {};
      layer.r.ds_de = shear_stiffness(G);
      layer.r.dp_dtheta = -K;
      layer.r.s = layer.material.kept() + layer.r.ds_de * _de;
      layer.r.p = layer.material.start().p;
      layer.weight = layer.fraction;
    }
    assemble();
    return step(0);
  }

  /// What residuals have been summed from at x: stress, and the stiffness
  /// times strains that may cancel [Pa].
  std::array<double, 2> sizes(const Unknowns& x) const
  {
    double stress = std::abs(_p), stiffness = 0;
    for (const Layer& layer : _layers)
    {
      const auto [G, K] = layer.material.moduli({}, _dt);
      stiffness = std::max(stiffness, 2 * G + K + std::abs(layer.r.dp_dtheta));
      stress += norm(layer.r.s) + std::abs(layer.r.p);
    }
    return {stress, stiffness * (x.norm() + _de.norm())};
  }
  double noise(const Unknowns& x) const
  {
    const auto [stress, strain] = sizes(x);
    return 1e-15 * (stress + strain);
  }
  double tolerance(const Unknowns& x) const
  {
    const auto [stress, strain] = sizes(x);
    return 1e-13 * stress + 4e-15 * strain;
  }

  double error() const { return _residual.norm(); }
  /// Newton's. Noise in the traction is none: its slope may be next to nothing.
  Unknowns step(double noise) const
  {
    Unknowns load = -_residual;
    for (int i = 0; i < 2; ++i)
      if (std::abs(load[i]) <= noise)
        load[i] = 0;
    return _slope.partialPivLu().solve(load);
  }
  Effort effort() const
  {
    Effort sum = _layers[0].r.effort;
    return sum += _layers[1].r.effort;
  }

  /// Volume strains of the layers at x, which is the last digits further than
  /// where the answers are.
  void settle(std::span<Share> shares, const Unknowns& x, int first) const
  {
    for (std::size_t k = 0; k < shares.size(); ++k)
    {
      const Layer& layer = _layers[static_cast<int>(k) == first ? 0 : 1];
      shares[k].answer.theta = layer.strain(_de, x, _N, _dt).theta;
    }
  }

  /// The mean at the unknowns `last` digits further, and its derivatives, the
  /// unknowns following `de` and `p`.
  void condense(const Unknowns& last, Driven& mean) const
  {
    Eigen::Matrix<double, 3, 5> loads; // by de, by p
    loads << -_residual_by_de, Unknowns(0, 0, 1);
    const Eigen::Matrix<double, 3, 5> follow =
        _slope.partialPivLu().solve(loads);
    const Six value = _mean + _mean_by_x * last;
    Eigen::Matrix<double, 6, 5> d = _mean_by_x * follow;
    d.leftCols<4>() += _mean_by_de;
    const Eigen::RowVector<double, 5> dtheta = _opening * follow;
    mean.s = value.head<4>();
    mean.flow = value[at_flow];
    mean.ds_de = d.topLeftCorner<4, 4>();
    mean.ds_dp = d.col(4).head<4>();
    mean.dflow_de = d.row(at_flow).head<4>();
    mean.dflow_dp = d(at_flow, 4);
    mean.dtheta_de = dtheta.head<4>();
    mean.dtheta_dp = dtheta[4];
  }

  int refused = -1;

private:
  /// Traction, from s and p.
  Eigen::Matrix<double, 2, 6> traction() const
  {
    Eigen::Matrix<double, 2, 6> T = Eigen::Matrix<double, 2, 6>::Zero();
    T.leftCols<4>() = _N.transpose();
    T.col(at_p) = -_N.transpose() * one;
    return T;
  }

  void assemble()
  {
    const auto& [a, b] = _layers;
    _mean = a.fraction * a.value() + b.fraction * b.value();
    _mean_by_de = a.fraction * a.by_de() + b.fraction * b.by_de();
    _mean_by_x =
        a.fraction * a.by_unknowns(_N) + b.fraction * b.by_unknowns(_N);
    _opening = a.weight * a.opening(_N) + b.weight * b.opening(_N);
    const Eigen::Matrix<double, 2, 6> T = traction();
    _residual << T * (a.value() - b.value()), _mean[at_p] - _p;
    const Eigen::Matrix<double, 2, 3> slope_a = T * a.by_unknowns(_N),
                                      slope_b = T * b.by_unknowns(_N);
    _slope << slope_a - slope_b, _mean_by_x.row(at_p);
    // layers whose grains are apart resist no shear: of all jumps the least
    const double size =
        slope_a.leftCols<2>().norm() + slope_b.leftCols<2>().norm();
    _slope.diagonal().head<2>().array() += 1e-14 * size;
    _residual_by_de << T * (a.by_de() - b.by_de()), _mean_by_de.row(at_p);
  }

  std::array<Layer, 2> _layers;
  Voigt _de;
  double _p, _dt;
  Jump _N;

  Six _mean;
  Eigen::Matrix<double, 6, 4> _mean_by_de;
  Eigen::Matrix<double, 6, 3> _mean_by_x;
  Eigen::RowVector3d _opening; ///< mean volume strain by the unknowns
  Unknowns _residual;
  Eigen::Matrix3d _slope;
  Eigen::Matrix<double, 3, 4> _residual_by_de;
};

/// Newton's method; a step that the laws refuse, or that makes the residual
/// larger, is halved.
Outcome balance(Layers& layers, Unknowns& x, Effort& effort)
{
  constexpr int max_evaluations = 60;
  x = layers.elastic();
  Unknowns last = Unknowns::Zero(), way = x;
  double error = scene::infinity;
  for (int i = 0; i < max_evaluations; ++i)
  {
    const bool known =
        x.allFinite()
        and layers.evaluate(x, TangentKind::consistent) == Outcome::ok;
    if (known)
    {
      effort += layers.effort();
      if (layers.error() <= layers.tolerance(x))
        return Outcome::ok;
    }
    if (known and layers.error() < error)
    {
      error = layers.error();
      last = x;
      way = layers.step(layers.noise(x));
    }
    else
      way /= 2;
    x = last + way;
  }
  return Outcome::reduce_step;
}
} // namespace

Outcome Laminate::operator()(std::span<Share> shares, const Voigt& de, double p,
                             double dt, TangentKind kind,
                             const Interface& interface, Mixed& mixed) const
{
  if (shares.size() < 2 or not(interface.area > 0))
    return EqualPressure{}(shares, de, p, dt, kind, interface, mixed);
  assert(interface.first >= 0
         and interface.first < static_cast<int>(shares.size()));
  Layers layers(shares, de, p, dt, interface);
  Unknowns x = Unknowns::Zero();
  Effort effort;
  Outcome outcome = balance(layers, x, effort);
  const Unknowns last = layers.step(layers.noise(x));
  if (outcome == Outcome::ok and kind != TangentKind::consistent)
    outcome = layers.evaluate(x, kind);
  mixed.refused = layers.refused;
  if (outcome != Outcome::ok)
    return outcome;
  mixed.refused = -1;
  layers.settle(shares, x + last, interface.first);
  if (not fill(shares, mixed))
    return Outcome::reduce_step;
  layers.condense(last, mixed.mean);
  mixed.mean.effort = effort;
  return mixed.mean.dtheta_dp < 0 ? Outcome::ok : Outcome::reduce_step;
}
} // namespace mmale::material
