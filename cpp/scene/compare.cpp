// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/compare.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

namespace mmale::scene
{
namespace
{
using Json = nlohmann::ordered_json;

/// Keys that may change at any time.
constexpr std::string_view any_time[] = {"title",
                                         "output.checkpoint_every",
                                         "output.fields_every",
                                         "output.chart.",
                                         "output.picture.",
                                         "solver.tolerance",
                                         "solver.max_iterations",
                                         "solver.lag_jacobian",
                                         "solver.line_search",
                                         "solver.tangent",
                                         "solver.geometric_stiffness",
                                         "solver.petsc"};

/// Keys of the present stage that may change.
constexpr std::string_view of_stage[] = {"name", "step_min", "step_max"};

/// Walks two scenes side by side.
class Comparison
{
public:
  explicit Comparison(const Standing& standing) : _standing(standing) {}

  void walk(const std::string& key, const Json& a, const Json& b)
  {
    if (key == "stage")
      stages(a, b);
    else if (is_table(a) and is_table(b) and not(a.is_null() and b.is_null()))
    {
      for (const auto& [name, value] : a.items())
        walk(below(key, name), value, b.contains(name) ? b[name] : Json());
      for (const auto& [name, value] : b.items())
        if (not a.contains(name))
          walk(below(key, name), Json(), value);
    }
    else if (a != b
             and std::ranges::none_of(any_time,
                                      [&](std::string_view k)
                                      {
                                        return (key + ".").starts_with(k)
                                               and (k.ends_with('.')
                                                    or key == k);
                                      }))
      tell(key, a, b);
  }

  std::vector<std::string> found;

private:
  /// What is not there may be a table without keys.
  static bool is_table(const Json& j) { return j.is_object() or j.is_null(); }

  static std::string below(const std::string& key, const std::string& name)
  {
    return key.empty() ? name : key + "." + name;
  }

  void tell(const std::string& key, const Json& a, const Json& b)
  {
    const auto text = [](const Json& j)
    { return j.is_null() ? std::string("nothing") : j.dump(); };
    found.push_back(key + " was " + text(a) + " and is " + text(b));
  }

  void stages(const Json& a, const Json& b)
  {
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      const int at = static_cast<int>(i);
      if (at > _standing.stage)
        return;
      const std::string key = "stage." + a[i].value("name", std::to_string(i));
      if (i >= b.size())
        tell(key, "there", Json());
      else if (at < _standing.stage)
        walk(key, a[i], b[i]);
      else
        present(key, a[i], b[i]);
    }
  }

  void present(const std::string& key, Json a, Json b)
  {
    const double end = b.value("duration", 0.0);
    // the last step may end a round-off beyond
    if (end < _standing.time * (1 - 1e-12))
      found.push_back(key + ".duration is " + Json(end).dump()
                      + " s, but the run is at " + Json(_standing.time).dump()
                      + " s of it");
    a.erase("duration");
    b.erase("duration");
    for (std::string_view name : of_stage)
    {
      a.erase(std::string(name));
      b.erase(std::string(name));
    }
    walk(key, a, b);
  }

  Standing _standing;
};
} // namespace

std::vector<std::string> differences(const std::string& before,
                                     const std::string& after,
                                     const Standing& standing)
{
  const Json a = Json::parse(before, nullptr, false),
             b = Json::parse(after, nullptr, false);
  if (a.is_discarded() or b.is_discarded())
    return {"the scene in the checkpoint cannot be read"};
  Comparison comparison(standing);
  comparison.walk("", a, b);
  return comparison.found;
}
} // namespace mmale::scene
