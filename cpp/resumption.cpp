// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/checkpoint.h"
#include "run.h"

namespace mmale
{
Resumption look_for_checkpoint(const std::filesystem::path& results,
                               const scene::Scene& scene,
                               const std::string& scene_as_understood)
{
  const auto found = output::find_checkpoint(results);
  Resumption out;
  if (not found.there)
    return out;
  out.way = Resumption::Way::resume;
  const auto file = (results / output::checkpoint_name).string();
  if (not found.trouble.empty())
  {
    out.complaints.push_back(found.trouble);
    return out;
  }
  for (const auto& line : scene::differences(
           found.header.scene, scene_as_understood, found.header.standing))
    out.complaints.push_back(file + ": " + line);
  // A stage that has become longer, or one more, is something left to do.
  const auto at = static_cast<std::size_t>(found.header.standing.stage);
  if (not out.complaints.empty() or not found.header.completed
      or at + 1 < scene.stage.size()
      or scene.stage.at(at).duration > found.header.standing.time * (1 + 1e-12))
    return out;
  out.way = Resumption::Way::completed;
  out.result.outcome = "completed";
  out.result.completed = true;
  out.result.checks_hold = found.header.checks_hold != 0;
  out.result.last = found.last;
  return out;
}
} // namespace mmale
