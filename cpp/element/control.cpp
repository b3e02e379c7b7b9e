// SPDX-License-Identifier: LGPL-3.0-or-later
#include "element/control.h"

#include "element/schema.h"
#include <cmath>

namespace mmale::element
{
namespace
{
// Signs of soil mechanics: the normal components count in compression.
const Voigt axial(0, -1, 0, 0), radial(-1, 0, 0, 0), tangential(0, 0, -1, 0),
    shear(0, 0, 0, 1), volume(-1, -1, -1, 0);

/// Builds the conditions of one path.
class Builder
{
public:
  explicit Builder(const State& start) : _start(start) {}

  /// The target's measure goes along a line, or in cycles.
  void drive_stress(const Voigt& a, double target, bool cycles = false)
  {
    add({.stress = a,
         .start = a.dot(_start.total()),
         .target = target,
         .cycles = cycles});
  }
  void drive_strain(const Voigt& b, double target, bool cycles = false)
  {
    add({.strain = b, .start = 0, .target = target, .cycles = cycles});
  }
  void hold_stress(const Voigt& a) { drive_stress(a, a.dot(_start.total())); }
  void hold_strain(const Voigt& b) { drive_strain(b, 0); }

  /// One of the two is given.
  void drive(const Voigt& a, const std::optional<double>& strain,
             const std::optional<double>& stress, bool cycles = false)
  {
    if (strain)
      drive_strain(a, *strain, cycles);
    else
      drive_stress(a, stress.value(), cycles);
  }

  void keep_water(bool undrained)
  {
    if (undrained)
      return hold_strain(volume);
    add({.pore_pressure = 1,
         .start = _start.pore_pressure,
         .target = _start.pore_pressure});
  }

  const Control& control() const { return _control; }

private:
  void add(const Condition& condition) { _control[_size++] = condition; }

  const State& _start;
  Control _control;
  std::size_t _size = 0;
};
} // namespace

Voigt State::total() const
{
  return stress - pore_pressure * Voigt(1, 1, 1, 0);
}

Control control_of(const Path& path, const State& start)
{
  Builder b(start);
  const bool cycles = path.cycles > 0;
  if (path.kind == kinds[isotropic])
  {
    b.drive_stress(axial - radial, 0);
    b.drive_stress(axial - tangential, 0);
    b.drive_stress(shear, 0);
    if (path.pressure)
      b.drive_stress(volume / 3, *path.pressure, cycles);
    else
      b.drive_strain(volume, path.eps_v.value(), cycles);
  }
  else if (path.kind == kinds[oedometric])
  {
    b.hold_strain(radial);
    b.hold_strain(tangential);
    b.hold_strain(shear);
    b.drive(axial, path.eps_a, path.sigma_a, cycles);
  }
  else if (path.kind == kinds[triaxial])
  {
    b.hold_stress(radial - tangential);
    b.hold_stress(path.hold == holds[1] ? Voigt(volume / 3) : radial);
    b.hold_strain(shear);
    if (path.q)
      b.drive_stress(axial - (radial + tangential) / 2, *path.q, cycles);
    else
      b.drive(axial, path.eps_a, path.sigma_a, cycles);
  }
  else if (path.kind == kinds[simple_shear])
  {
    b.hold_strain(radial);
    b.hold_strain(tangential);
    b.hold_stress(axial);
    b.drive(shear, path.gamma, path.tau, cycles);
  }
  else
  {
    b.drive(axial, path.eps_a, path.sigma_a);
    b.drive(radial, path.eps_r, path.sigma_r);
    b.drive(tangential, path.eps_t, path.sigma_t);
    b.drive(shear, path.gamma, path.tau);
  }
  b.keep_water(path.drainage == drainages[1]);
  return b.control();
}

double value(const Condition& c, const Progress& progress)
{
  if (not c.cycles)
    return c.start + progress.share * (c.target - c.start);
  // up in a quarter, down in two, up in the last one
  const double phase = progress.cycle - std::floor(progress.cycle);
  const double wave = phase < 0.25   ? 4 * phase
                      : phase < 0.75 ? 2 - 4 * phase
                                     : 4 * phase - 4;
  return c.start + wave * c.target;
}

bool turns(const Path& path)
{
  return path.kind == kinds[simple_shear];
}
} // namespace mmale::element
