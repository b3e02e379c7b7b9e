// SPDX-License-Identifier: LGPL-3.0-or-later
#include "step_control.h"

#include <algorithm>

namespace mmale
{
StepControl::StepControl(const scene::Stage& stage, std::vector<double> marks,
                         int most)
    : _end(stage.duration), _step(stage.step),
      _floor(stage.step_min > 0 ? stage.step_min : stage.step / 1024),
      _ceiling(stage.step_max > 0 ? stage.step_max : stage.step),
      _easy(std::max(1, most / 3)), _marks(std::move(marks))
{
  _marks.push_back(_end);
  std::ranges::sort(_marks);
}

double StepControl::next() const
{
  const auto mark = std::ranges::find_if(
      _marks, [this](double m) { return m > _time * (1 + 1e-12) + 1e-300; });
  const double target = mark == _marks.end() ? _end : *mark;
  const double left = target - _time;
  // no crumbs: a last piece of under half a step is shared with the one before
  if (left <= _step * (1 + 1e-9))
    return target;
  return left < 1.5 * _step ? _time + 0.5 * left : _time + _step;
}

void StepControl::accepted(int iterations)
{
  _time = next();
  if (_time >= _end * (1 - 1e-12))
    _time = _end;
  if (iterations <= _easy)
    _step = std::min(_ceiling, 1.5 * _step);
}

bool StepControl::failed()
{
  _step = 0.5 * (next() - _time);
  return _step >= _floor;
}
} // namespace mmale
