// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

/// Rates of hypoplastic sand and their derivatives (METHOD.md, step 1a).
///
/// Stress, strain and intergranular strain are Mandel vectors here: the shear
/// components carry a factor of sqrt 2, so that products and norms of tensors
/// are those of vectors. N = 4: xx yy zz xy; N = 6: 11 22 33 12 23 13.
/// @source von Wolffersdorff (1996), Mech. Cohes.-Frict. Mater. 1, 251-271;
/// Niemunis & Herle (1997), the same 2, 279-299
namespace mmale::material::hypoplasticity
{
template <int N>
using Tensor = Eigen::Vector<double, N>;
template <int N>
using Tensor2 = Eigen::Matrix<double, N, N>;

template <int N>
Tensor<N> unit()
{
  Tensor<N> one = Tensor<N>::Zero();
  one.template head<3>().setOnes();
  return one;
}

template <int N>
double trace(const Tensor<N>& x)
{
  return x[0] + x[1] + x[2];
}

/// x x, whose trace is x . x.
inline Tensor<4> squared(const Tensor<4>& x)
{
  const double m = 0.5 * x[3] * x[3];
  return {x[0] * x[0] + m, x[1] * x[1] + m, x[2] * x[2], x[3] * (x[0] + x[1])};
}

inline Tensor<6> squared(const Tensor<6>& x)
{
  const double a = x[3], b = x[4], c = x[5], r = std::sqrt(0.5);
  return Tensor<6>{
      {x[0] * x[0] + 0.5 * (a * a + c * c), x[1] * x[1] + 0.5 * (a * a + b * b),
       x[2] * x[2] + 0.5 * (b * b + c * c), a * (x[0] + x[1]) + r * b * c,
       b * (x[1] + x[2]) + r * a * c, c * (x[0] + x[2]) + r * a * b}};
}

/// The law's constants, and what follows from them once.
struct Sand
{
  double a;             ///< of the critical state's cone
  double h_s, n;        ///< [Pa], [-]
  double e_d, e_c, e_i; ///< limits of the void ratio at zero pressure
  double alpha, beta;
  double f_b;         ///< barotropy without its powers of the pressure [Pa]
  double f_e, f_d;    ///< on e_i: there they are the same at any pressure
  double m_R, m_T, R; ///< of the intergranular strain
  double beta_R, chi;
  double core;  ///< |h|/R below which |h|^beta_R is made smooth
  double floor; ///< least pressure at which rates are taken, p_min [Pa]
  double cone;  ///< I1 I2/I3 of the widest cone allowed
};

/// Factors of pressure and void ratio, and their derivatives.
struct Factors
{
  double f_s = 0;        ///< f_b f_e [Pa]
  double dp = 0, de = 0; ///< derivatives of ln f_s
  double f_d = 0;        ///< 0 where the sand is as dense as can be
  double fd_p = 0;       ///< its derivative by the pressure
  double fd_e = 0;       ///< and by the void ratio
  bool clipped = false;  ///< void ratio taken at a limit
};

/// A void ratio outside [e_d, e_i] counts as the limit. Departure: f_d has an
/// infinite slope at e_d; in the last 1e-4 of the way from e_c to e_d it goes
/// along a line to zero.
inline Factors factors(const Sand& c, double p, double e)
{
  constexpr double last = 1e-4;
  const double log_x = std::log(3 * p / c.h_s);
  const double X = std::exp(c.n * log_x), bauer = std::exp(-X);
  const double slope = c.n * X / p; // -d ln(e_i)/dp
  const double e_i = c.e_i * bauer, e_d = c.e_d * bauer;
  Factors f;
  f.f_s = c.f_b * (1 + e_i) / e_i * 3 * p / (c.h_s * X);
  f.dp = (1 - c.n) / p + slope / (1 + e_i);
  f.clipped = not(e < e_i and e > e_d);
  if (not(e < e_i))
  {
    f.f_s *= c.f_e;
    f.f_d = c.f_d;
    return f;
  }
  if (f.clipped)
  {
    f.f_s *= std::pow(c.e_c / c.e_d, c.beta);
    return f;
  }
  f.f_s *= std::exp(c.beta * (std::log(c.e_c / e) - X));
  f.dp -= c.beta * slope;
  f.de = -c.beta / e;
  const double breadth = (c.e_c - c.e_d) * bauer;
  const double r = (e - e_d) / breadth;
  double by_r;
  if (r > last)
  {
    f.f_d = std::exp(c.alpha * std::log(r));
    by_r = c.alpha * f.f_d / r;
  }
  else
  {
    by_r = std::pow(last, c.alpha - 1);
    f.f_d = by_r * r;
  }
  f.fd_p = by_r * slope * e / breadth;
  f.fd_e = by_r / breadth;
  return f;
}

/// F of the stress deviator over the trace: 1 in triaxial compression.
template <int N>
struct Lode
{
  double q = 0;     ///< Td . Td
  double cubic = 0; ///< tr Td^3
  double F = 1;
  Tensor<N> by_Td = Tensor<N>::Zero(); ///< derivative of F
};

template <int N>
Lode<N> lode(const Tensor<N>& Td)
{
  Lode<N> l;
  const Tensor<N> Td2 = squared(Td);
  l.q = Td.squaredNorm();
  l.cubic = Td2.dot(Td);
  if (not(l.q > 1e-26))
    return l; // on the axis any Lode angle will do
  const double t2 = 3 * l.q, t = std::sqrt(t2);
  // sqrt2 tan psi cos 3 theta, which round-off may take past its ends
  const double end = std::sqrt(2.0) * t;
  const double k = std::clamp(-6 * l.cubic / l.q, -end, end);
  const double m = 1 / (2 + k), g = (2 - t2) * m;
  const double root = std::sqrt(t2 / 8 + g);
  l.F = root - t / std::sqrt(8.0);
  const double by_t2 = (0.125 - m) / (2 * root) - 1 / (t * std::sqrt(32.0));
  const double by_k = -g * m / (2 * root);
  l.by_Td = (6 * by_t2 + 12 * by_k * l.cubic / (l.q * l.q)) * Td
            - (18 * by_k / l.q) * Td2;
  return l;
}

/// What intergranular strain makes of the strain rate.
template <int N>
struct Grains
{
  Tensor<N> hd = Tensor<N>::Zero(); ///< direction of h
  double rho = 0;                   ///< |h|/R
  double s = 0;                     ///< hd : D
  bool along = false;               ///< the law's case of s > 0
  double w = 0;                     ///< rho^chi
  double stiff = 0;                 ///< factor of L : D
  double turn = 0;                  ///< of (L : hd)(hd : D), without w
  double decay = 0;                 ///< rho^beta_R
  double by_rho = 0;                ///< derivative of decay
  Tensor<N> rate = Tensor<N>::Zero();
};

/// @param[in] along which of the law's two cases: hd : D > 0. They meet where
/// it is 0, but their derivatives do not.
template <int N>
Grains<N> grains(const Sand& c, const Tensor<N>& h, const Tensor<N>& D,
                 bool along)
{
  Grains<N> r;
  const double size = h.norm();
  r.rate = D;
  r.along = along;
  r.stiff = c.m_R;
  if (not(size > 1e-14 * c.R))
    return r;
  r.hd = h / size;
  r.rho = size / c.R;
  r.s = r.hd.dot(D);
  const double log_rho = std::log(r.rho);
  r.w = std::exp(c.chi * log_rho);
  r.stiff = c.m_R + r.w * (c.m_T - c.m_R);
  if (not along)
  {
    r.turn = c.m_R - c.m_T;
    return r;
  }
  r.turn = 1 - c.m_T;
  // rho^beta_R bends without bound at 0, where it does not matter
  if (r.rho > c.core)
  {
    r.decay = std::exp(c.beta_R * log_rho);
    r.by_rho = c.beta_R * r.decay / r.rho;
  }
  else
  {
    r.by_rho = std::pow(c.core, c.beta_R - 1);
    r.decay = r.by_rho * r.rho;
  }
  r.rate -= (r.decay * r.s) * r.hd;
  return r;
}

/// Derivatives of the rates of stress and of intergranular strain.
template <int N>
struct Slopes
{
  Tensor2<N> by_T, by_h, by_D;
  Tensor<N> by_e;
  Tensor2<N> h_by_h, h_by_D;
};

/// Rate of the stress at a state along a path, with all that its derivatives
/// need.
///
/// Without intergranular strain the stress rate is L : D + f_d N |D|. With it
/// the law is brought to the same shape, L : g + f_d N k.
template <int N, bool with_grains>
struct Rate
{
  Tensor<N> stress; ///< rate of T, the floor minded
  Factors factor;
  Lode<N> lode;
  Grains<N> grains; ///< only with_grains
  double p;         ///< -tr T/3
  double landing;   ///< share of a fall of the pressure that the floor stops

  /// @param[in] T stress less the cohesion shift [Pa]
  /// @param[in] e void ratio
  /// @param[in] h intergranular strain; not looked at without it
  /// @param[in] D strain rate; `size` its norm
  /// @param[in] along of `grains`
  void evaluate(const Sand& c, const Tensor<N>& T, double e, const Tensor<N>& h,
                const Tensor<N>& D, double size, bool along);

  /// The derivatives, with the same arguments.
  void slopes(const Sand& c, const Tensor<N>& T, const Tensor<N>& D,
              double size, Slopes<N>& out) const;

  /// m_R L, the law's stiffest.
  Tensor2<N> stiffest(const Sand& c) const
  {
    Tensor2<N> L = (c.a * c.a) * Th * Th.transpose();
    L.diagonal().array() += lode.F * lode.F;
    return c.m_R * _fs * L;
  }

  /// Stress ratio T/tr T, and its deviator.
  Tensor<N> Th, Td;

private:
  Tensor<N> _g, _free; // _free: rate of the law without the floor
  double _k, _A;       // _A: Th : g
  double _fs;          // f_b f_e/(Th : Th)
  double _fall;        // rate of the pressure without the floor, if below 0

  void floor_slopes(const Sand& c, const Tensor<N>& T, Slopes<N>& out) const;
  void grain_slopes(const Sand& c, const Tensor2<N>& L, const Tensor<N>& n,
                    const Tensor<N>& D, Slopes<N>& out) const;
};

template <int N, bool with_grains>
void Rate<N, with_grains>::evaluate(const Sand& c, const Tensor<N>& T, double e,
                                    const Tensor<N>& h, const Tensor<N>& D,
                                    double size, bool along)
{
  const Tensor<N> one = unit<N>();
  const double tr = trace<N>(T);
  p = -tr / 3;
  factor = hypoplasticity::factors(c, p, e);
  Th = T / tr;
  Td = Th - one / 3;
  lode = hypoplasticity::lode<N>(Td);
  if constexpr (with_grains)
  {
    grains = hypoplasticity::grains<N>(c, h, D, along);
    _g = grains.stiff * D + (grains.turn * grains.w * grains.s) * grains.hd;
    _k = along ? grains.w * grains.s : 0;
  }
  else
  {
    _g = D;
    _k = size;
  }
  _fs = factor.f_s / (1.0 / 3 + lode.q); // Th : Th = 1/3 + Td : Td
  _A = Th.dot(_g);
  const double F = lode.F, a = c.a;
  _free = _fs
          * (F * F * _g + (a * a * _A) * Th
             + (factor.f_d * _k * a * F) * (Th + Td));
  // The floor: from twice p_min down a growing share of a fall of the pressure
  // is made up by a stress along the ray, whose ratio stays what it is.
  stress = _free;
  const double x = std::clamp(2 - p / c.floor, 0.0, 1.0);
  landing = x * x;
  _fall = 0;
  if (landing > 0)
  {
    _fall = std::min(0.0, -trace<N>(_free) / 3);
    stress -= (landing * _fall / p) * T;
  }
}

template <int N, bool with_grains>
void Rate<N, with_grains>::slopes(const Sand& c, const Tensor<N>& T,
                                  const Tensor<N>& D, double size,
                                  Slopes<N>& out) const
{
  const Tensor<N> one = unit<N>();
  const double tr = -3 * p, F = lode.F, a = c.a;
  const double K = factor.f_d * _k, square = 1.0 / 3 + lode.q;
  const Tensor<N> n = (_fs * a * F) * (Th + Td); // N
  // change of f_s, F, T/tr T and f_d in turn; that of T/tr T is
  // (dT - Th tr dT)/tr
  const Tensor<N> of_fs =
      (-2 / (square * tr)) * (Th - square * one) - (factor.dp / 3) * one;
  const Tensor<N> of_F = (1 / tr) * (lode.by_Td - lode.by_Td.dot(Th) * one);
  const Tensor<N> with_F = _fs * (2 * F * _g + (K * a) * (Th + Td));
  const double ratio = _fs * (a * a * _A + 2 * K * a * F) / tr;
  const Tensor<N> lean = (_fs * a * a / tr) * Th;
  out.by_T.noalias() = _free * of_fs.transpose();
  out.by_T.noalias() += with_F * of_F.transpose();
  out.by_T.noalias() += lean * (_g - _A * one).transpose();
  out.by_T.template leftCols<3>().colwise() -=
      ratio * Th + (_k * factor.fd_p / 3) * n;
  out.by_T.diagonal().array() += ratio;
  out.by_e = factor.de * _free + (_k * factor.fd_e) * n;

  Tensor2<N> L = (_fs * a * a) * Th * Th.transpose();
  L.diagonal().array() += _fs * F * F;
  if constexpr (with_grains)
    grain_slopes(c, L, factor.f_d * n, D, out);
  else
  {
    out.by_D = L;
    if (size > 0)
      out.by_D.noalias() += (factor.f_d / size) * n * D.transpose();
  }
  if (landing > 0)
    floor_slopes(c, T, out);
}

/// @param[in] n f_d N
template <int N, bool with_grains>
void Rate<N, with_grains>::grain_slopes(const Sand& c, const Tensor2<N>& L,
                                        const Tensor<N>& n, const Tensor<N>& D,
                                        Slopes<N>& out) const
{
  const auto& r = grains;
  const Tensor<N> Lh = L * r.hd;
  Tensor<N> by_s = (r.turn * r.w) * Lh; // of hd : D
  if (r.along)
    by_s += r.w * n;
  out.by_D = r.stiff * L;
  out.by_D.noalias() += by_s * r.hd.transpose();
  out.h_by_D.setIdentity();
  if (not(r.rho > 0))
  {
    out.by_h.setZero();
    out.h_by_h.setZero();
    return;
  }
  Tensor<N> by_w = (c.m_T - c.m_R) * (L * D) + (r.turn * r.s) * Lh;
  if (r.along)
    by_w += r.s * n;
  const double size = r.rho * c.R;
  const Tensor<N> across = D - r.s * r.hd;
  const double turn = r.turn * r.w * r.s / size;
  out.by_h.noalias() =
      ((c.chi * r.w / size) * by_w - turn * Lh) * r.hd.transpose();
  out.by_h.noalias() += (by_s / size) * across.transpose();
  out.by_h += turn * L;
  if (not r.along)
  {
    out.h_by_h.setZero();
    return;
  }
  out.h_by_D.noalias() -= r.decay * r.hd * r.hd.transpose();
  const double hold = r.decay * r.s / size;
  out.h_by_h.noalias() =
      r.hd
      * ((hold - r.by_rho * r.s / c.R) * r.hd - (r.decay / size) * across)
            .transpose();
  out.h_by_h.diagonal().array() -= hold;
}

template <int N, bool with_grains>
void Rate<N, with_grains>::floor_slopes(const Sand& c, const Tensor<N>& T,
                                        Slopes<N>& out) const
{
  if (not(_fall < 0))
    return;
  const Tensor<N> one = unit<N>();
  const Tensor<N> ray = (landing / (3 * p)) * T; // times the change of _fall
  const auto mind = [&](auto& slope)
  {
    const auto sums = slope.template topRows<3>().colwise().sum().eval();
    slope.noalias() += ray * sums;
  };
  mind(out.by_T);
  mind(out.by_D);
  mind(out.by_e);
  if constexpr (with_grains)
    mind(out.by_h);
  const double x = std::clamp(2 - p / c.floor, 0.0, 1.0);
  const double by_p =
      _fall * (-2 * x / c.floor * (x < 1) / p - landing / (p * p));
  out.by_T.noalias() += (by_p / 3) * T * one.transpose();
  out.by_T.diagonal().array() -= landing * _fall / p;
}
} // namespace mmale::material::hypoplasticity
