// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace mmale::scene
{
/// Where a run stands when it shall go on with a scene.
struct Standing
{
  int stage = 0;   ///< the stage it is in, from 0
  double time = 0; ///< in that stage [s]
};

/// What keeps a run that was begun with a scene from going on with another.
///
/// What lies ahead may be another: later stages, the end of the present one
/// and its step bounds, how hard the solver tries, the title, when fields and
/// checkpoints are written, charts and pictures.
///
/// @param[in] before,after scenes as `describe` writes them
/// @return a line for each key, with both values; empty is good
std::vector<std::string> differences(const std::string& before,
                                     const std::string& after,
                                     const Standing& standing);
} // namespace mmale::scene
