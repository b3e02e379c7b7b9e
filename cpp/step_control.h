// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/scene.h"
#include <algorithm>
#include <vector>

namespace mmale
{
/// Size of the steps of a stage: a failed one is halved, easy ones grow, none
/// passes a time at which something is written.
class StepControl
{
public:
  /// @param[in] marks times to be met exactly, from the start of the stage [s]
  /// @param[in] most  iterations that a step may take; one with a third of them
  ///                  is easy. (Five whatever the most: friction takes six at
  ///                  any step, and steps once halved stayed small.)
  StepControl(const scene::Stage& stage, std::vector<double> marks, int most);

  double time() const { return _time; }
  bool finished() const { return _time >= _end; }

  /// End of the step to try [s].
  double next() const;

  /// The step was taken with so many iterations; an easy one lets the next
  /// grow by half.
  void accepted(int iterations);

  /// The step failed.
  /// @return false when the floor is reached
  [[nodiscard]] bool failed();

  double step() const { return _step; }
  double floor() const { return _floor; }

  /// Where the stage stands. What stopped at the floor tries it once more.
  template <class Archive>
  void keep(Archive& archive)
  {
    archive("run/time_in_stage", _time);
    archive("run/next_step", _step);
    if (archive.loading())
      _step = std::max(_step, _floor);
  }

private:
  double _time = 0, _end, _step, _floor, _ceiling;
  int _easy; ///< iterations up to which the next step grows
  std::vector<double> _marks;
};
} // namespace mmale
