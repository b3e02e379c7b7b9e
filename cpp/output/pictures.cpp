// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/pictures.h"

#include "output/summary.h"
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

extern "C" char** environ;

namespace mmale::output
{
namespace
{
using nlohmann::ordered_json;

/// Run a program to its end.
/// @param[out] said the last of what it wrote to both its outputs
/// @return empty, or why it failed
std::string run(const std::vector<std::string>& words, std::string& said)
{
  std::array<int, 2> pipe = {};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    return std::strerror(errno);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : words)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, arguments[0], &actions, nullptr,
                                   arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(pipe[1]);

  constexpr std::size_t keep = 4000;
  std::array<char, 1024> buffer;
  ssize_t n = 0;
  while (error == 0
         and ((n = ::read(pipe[0], buffer.data(), buffer.size())) > 0
              or (n < 0 and errno == EINTR)))
    if (n > 0)
    {
      said.append(buffer.data(), static_cast<std::size_t>(n));
      if (said.size() > keep)
        said.erase(0, said.size() - keep);
    }
  ::close(pipe[0]);
  if (error != 0)
    return words[0] + ": " + std::strerror(error);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 and errno == EINTR)
    ;
  if (WIFEXITED(status) and WEXITSTATUS(status) == 0)
    return {};
  return words[0] + " ended with "
         + (WIFEXITED(status) ? "code " + std::to_string(WEXITSTATUS(status))
                              : "signal " + std::to_string(WTERMSIG(status)));
}

/// The line that tells most: the last one of a Python traceback.
std::string last_line(const std::string& text)
{
  const std::size_t end = text.find_last_not_of(" \n\r\t");
  if (end == std::string::npos)
    return {};
  const std::size_t begin = text.find_last_of('\n', end);
  const std::size_t from = begin == std::string::npos ? 0 : begin + 1;
  return text.substr(from, end + 1 - from);
}

ordered_json json(std::span<const KnownPoint> points)
{
  ordered_json out = ordered_json::array();
  for (const KnownPoint& k : points)
    out.push_back({{"x", k.x}, {"at", k.at}, {"y", k.y}, {"value", k.value}});
  return out;
}

ordered_json json(const Chart& chart)
{
  constexpr std::array layouts = {"together", "panels", "diagnostics"};
  ordered_json lines = ordered_json::array();
  for (const ReferenceLine& line : chart.references)
    lines.push_back({{"value", line.value}, {"label", line.label}});
  return {{"file", chart.name + ".png"},
          {"layout", layouts[static_cast<std::size_t>(chart.layout)]},
          {"title", chart.title},
          {"x", chart.x},
          {"x_label", chart.x_label},
          {"y", chart.y},
          {"y_label", chart.y_label},
          {"references", lines},
          {"points", json(chart.points)}};
}

ordered_json json(const Sheet& sheet)
{
  ordered_json panels = ordered_json::array();
  for (const Panel& p : sheet.panels)
    panels.push_back({{"x", p.x}, {"y", p.y}, {"log_x", p.log_x}});
  return {{"file", sheet.name + ".png"},
          {"panels", panels},
          {"points", json(sheet.points)},
          {"data", sheet.data}};
}

/// Run draw.py with these words after its name; empty, or why it failed.
std::string run_draw(std::vector<std::string> words)
{
  const std::filesystem::path program = draw_program();
  std::error_code unreadable;
  if (not std::filesystem::exists(program, unreadable))
    return program.string() + " is not there; MMALE_DRAW may name another";
  words.insert(words.begin(), {"python3", program.string()});
  std::string said;
  const std::string failed = run(words, said);
  if (failed.empty())
    return {};
  const std::string reason = last_line(said);
  return failed + (reason.empty() ? "" : ": " + reason);
}

/// The scene's charts as it names them.
std::vector<Chart> own_charts(const scene::Scene& scene,
                              const std::vector<KnownPoint>& points)
{
  std::vector<Chart> out;
  for (const auto& [name, c] : scene.output.chart)
    out.push_back({.name = name,
                   .x = c.x,
                   .y = c.y,
                   .references = c.references,
                   .points = points,
                   .title = c.title,
                   .x_label = c.x_label,
                   .y_label = c.y_label});
  return out;
}

/// Columns that no chart shows.
std::vector<std::string> left_over(std::span<const std::string> columns,
                                   std::span<const Chart> charts)
{
  std::vector<std::string> out;
  for (const std::string& column : columns)
    if (std::ranges::none_of(charts,
                             [&](const Chart& c)
                             {
                               return c.x == column
                                      or std::ranges::find(c.y, column)
                                             != c.y.end();
                             }))
      out.push_back(column);
  return out;
}
} // namespace

std::vector<KnownPoint> known_points(std::span<const Reference> references)
{
  std::vector<KnownPoint> out;
  for (const Reference& r : references)
    if (r.take == Reference::Take::at
        and r.relation == Reference::Relation::near)
      out.push_back({r.at.first, r.at.second, r.curve, r.reference});
  return out;
}

std::vector<Chart> charts(std::span<const std::string> curves,
                          std::span<const Reference> references)
{
  std::vector<Chart> out;
  for (const Reference& r : references)
  {
    if (r.curve.empty() or r.take != Reference::Take::at)
      continue;
    const std::string name = r.curve + "_over_" + r.at.first;
    auto chart = std::ranges::find(out, name, &Chart::name);
    if (chart == out.end())
    {
      out.push_back({.name = name, .x = r.at.first, .y = {r.curve}});
      chart = out.end() - 1;
    }
    if (r.relation == Reference::Relation::near
        and std::ranges::find(chart->references, r.reference,
                              &ReferenceLine::value)
                == chart->references.end())
      chart->references.push_back(
          {r.reference, r.source.empty() ? r.name : r.source});
  }
  // A variety of a charted curve (p_sy_eff of p_sy) belongs beside it.
  for (const std::string& curve : left_over(curves, out))
    for (Chart& chart : out)
      if (curve.starts_with(chart.y.front() + "_"))
      {
        chart.y.push_back(curve);
        break;
      }
  return out;
}

Pictures pictures(const scene::Scene& scene,
                  std::span<const std::string> columns,
                  std::span<const Reference> references,
                  const std::map<std::string, FieldInfo>& info)
{
  std::vector<std::string> own, others;
  for (const std::string& column : columns)
    if (column != "time")
      (scene.output.curve.contains(column) ? own : others).push_back(column);
  Pictures out{.title = scene.title,
               .charts = own_charts(scene, known_points(references)),
               .fields = scene.output.picture,
               .info = info,
               .axisymmetric = scene.symmetry == scene::Symmetry::axisymmetric};
  if (out.charts.empty())
    out.charts = charts(own, references);
  if (auto rest = left_over(own, out.charts); not rest.empty())
    out.charts.push_back({.name = "curves",
                          .x = "time",
                          .y = std::move(rest),
                          .layout = Layout::panels});
  if (not others.empty())
    out.charts.push_back({.name = "diagnostics",
                          .x = "time",
                          .y = std::move(others),
                          .layout = Layout::diagnostics});
  return out;
}

std::string to_json(const Pictures& p)
{
  ordered_json charts = ordered_json::array();
  for (const Chart& chart : p.charts)
    charts.push_back(json(chart));
  ordered_json fields = ordered_json::array();
  for (const auto& [name, picture] : p.fields)
  {
    const auto info = p.info.find(picture.field);
    fields.push_back(
        {{"file", name + ".png"},
         {"field", picture.field},
         {"unit", info == p.info.end() ? "" : info->second.unit},
         {"mesh", picture.mesh},
         {"surface", picture.surface},
         {"start", picture.start},
         {"arrows",
          picture.arrows ? ordered_json(p.arrows) : ordered_json(nullptr)},
         {"time", std::isfinite(picture.at) ? ordered_json(picture.at)
                                            : ordered_json(nullptr)}});
  }
  ordered_json domains = ordered_json::array();
  for (const std::string& name : p.domains)
    domains.push_back({{"file", name + ".png"},
                       {"name", name},
                       {"outline", name + ".txt"},
                       {"pieces", name + ".vtp"}});
  ordered_json sheets = ordered_json::array();
  for (const Sheet& sheet : p.sheets)
    sheets.push_back(json(sheet));
  const ordered_json out = {
      {"title", p.title},           {"axisymmetric", p.axisymmetric},
      {"curves", "curves.csv"},     {"charts", charts},
      {"field_file", p.field_file}, {"fields", fields},
      {"domains", domains},         {"sheets", sheets}};
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

std::filesystem::path draw_program()
{
  if (const char* path = std::getenv("MMALE_DRAW"); path and *path)
    return path;
  return MMALE_DRAW_PROGRAM;
}

std::string draw(const std::filesystem::path& folder, const Pictures& pictures)
{
  try
  {
    write_atomically(folder / "pictures.json", to_json(pictures));
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return run_draw({"run", folder.string()});
}

std::string draw_sweep(const std::filesystem::path& folder,
                       std::span<const std::filesystem::path> members)
{
  std::vector<std::string> words = {"sweep", folder.string()};
  for (const auto& member : members)
    words.push_back(member.string());
  return run_draw(std::move(words));
}
} // namespace mmale::output
