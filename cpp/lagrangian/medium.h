// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kinematics.h"
#include "material/library.h"
#include "material/water.h"
#include "scene/scene.h"
#include <optional>
#include <span>
#include <vector>

namespace mmale::lagrangian
{
/// A material as an element sees it: a law, the water in its pores, and how
/// the numbers of a point lie in the history.
class Medium
{
public:
  /// @param[in] law   kept by reference
  /// @param[in] water of the scene, or none
  Medium(const material::AnyLaw& law, const std::optional<scene::Water>& water);

  const material::AnyLaw& law() const { return *_law; }
  bool is_void() const { return std::holds_alternative<material::Void>(*_law); }
  /// Has its deviator no memory?
  bool fluid() const { return _fluid; }
  /// Has the law a zero-stress floor?
  bool has_floor() const;
  int num_history() const { return _num_history; } ///< of a point
  /// Does the water flow?
  bool flows() const { return _flows; }
  const std::optional<material::Water>& water() const { return _water; }
  double water_density() const { return _rho_f; } ///< [kg/m3]
  int void_ratio() const { return _void_ratio; }  ///< where it is, or -1

  /// Numbers of a point at the start of a run, and its density [kg/m3].
  /// @param[in]  p_w pore pressure, if there is water [Pa]
  /// @param[out] q   the first `num_history` are set
  double begin(const material::Start& start, double p_w,
               std::span<double> q) const;

  /// Pressure of a point by which it is driven: the total one, or the
  /// effective one where the water flows [Pa].
  double driven_pressure(double p, std::span<const double> q) const
  {
    return _flows ? p - material::pores(q.first(_num_history)).p_w : p;
  }

  /// Turn the tensors in the history of a point by the half step's rotation.
  void turn(std::span<double> q, double cosine, double sine) const
  {
    for (int at : _tensors)
    {
      Eigen::Map<Voigt> t(q.data() + at);
      t = rotate(Voigt(t), cosine, sine);
    }
  }

  /// Calls f with what makes a point's answer, the law and the water that is
  /// in it, of a pore pressure at the end of the step; it goes to
  /// `material::drive`.
  auto with(auto&& f) const
  {
    return std::visit(
        [&]<class L>(const L& law)
        {
          if (not _water)
            return f([&law](double) -> const L& { return law; });
          const material::Water& water = *_water;
          if (not _flows)
            return f([&](double)
                     { return material::Undrained<L>{law, water}; });
          return f([&](double p_w)
                   { return material::Seeping<L>{law, water, p_w}; });
        },
        *_law);
  }

private:
  const material::AnyLaw* _law;
  bool _fluid;
  std::optional<material::Water> _water;
  bool _flows = false;
  double _rho_f = 0;
  double _porosity = 0; ///< at the start, if no void ratio tells it
  int _num_history;
  std::vector<int> _tensors; ///< where in the history one begins
  int _void_ratio;
};
} // namespace mmale::lagrangian
