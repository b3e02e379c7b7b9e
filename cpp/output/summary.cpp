// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/summary.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <unistd.h>

#ifndef MMALE_VERSION
#error "MMALE_VERSION is defined by CMake"
#endif

namespace mmale::output
{
namespace
{
using nlohmann::ordered_json;

ordered_json number(double value)
{
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json json(const Check& check)
{
  const Reference& r = check.reference;
  constexpr std::array relations = {"near", "at_least", "at_most"};
  ordered_json out = {{"name", r.name},
                      {"value", number(check.value.value_or(NAN))},
                      {"reference", number(r.reference)},
                      {"tolerance", number(r.tolerance)},
                      {"holds", check.holds},
                      {"relation", relations[std::size_t(r.relation)]}};
  if (not r.unit.empty())
    out["unit"] = r.unit;
  if (not r.source.empty())
    out["source"] = r.source;
  return out;
}

ordered_json json(const LedgerEntry& entry)
{
  return {{"name", entry.name},
          {"unit", entry.unit},
          {"start", number(entry.start)},
          {"end", number(entry.end)},
          {"through_surface", number(entry.through_surface)},
          {"booked", number(entry.booked)},
          {"relative_change", number(entry.relative_change())}};
}

ordered_json json(const Timing& timing)
{
  return {{"name", timing.name},
          {"seconds", number(timing.seconds)},
          {"share", number(timing.share)},
          {"calls", timing.calls},
          {"cells_per_second", number(timing.cells_per_second)}};
}

ordered_json json(const Deviation& d)
{
  return {{"column", d.column},
          {"abscissa", d.abscissa},
          {"points", d.points},
          {"outside", d.outside},
          {"rms", number(d.rms)}};
}

template <class T>
ordered_json list(const std::vector<T>& entries)
{
  ordered_json out = ordered_json::array();
  for (const T& entry : entries)
    out.push_back(json(entry));
  return out;
}

ordered_json scene(const std::string& text)
{
  ordered_json parsed = ordered_json::parse(text, nullptr, false);
  return parsed.is_discarded() ? ordered_json(text) : parsed;
}

/// A file that goes away unless it was brought to its place.
class Neighbour
{
public:
  explicit Neighbour(const std::filesystem::path& file)
      : _target(file), _path(file.string() + ".part"),
        _fd(::open(_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC,
                   0666))
  {
    if (_fd < 0)
      fail(errno);
  }

  Neighbour(const Neighbour&) = delete;
  Neighbour& operator=(const Neighbour&) = delete;

  ~Neighbour()
  {
    if (_fd >= 0)
      ::close(_fd);
    if (not _moved)
      ::unlink(_path.c_str());
  }

  void write(std::string_view text)
  {
    while (not text.empty())
    {
      const ssize_t n = ::write(_fd, text.data(), text.size());
      if (n < 0 and errno != EINTR)
        fail(errno);
      text.remove_prefix(n > 0 ? static_cast<std::size_t>(n) : 0);
    }
  }

  void move_to_target()
  {
    // Without fsync a power cut could leave a renamed, empty file. Some file
    // systems cannot sync (EINVAL), which is no loss of what was written.
    if (::fsync(_fd) != 0 and errno != EINVAL)
      fail(errno);
    if (::close(std::exchange(_fd, -1)) != 0)
      fail(errno);
    if (::rename(_path.c_str(), _target.c_str()) != 0)
      fail(errno);
    _moved = true;
  }

private:
  [[noreturn]] void fail(int error) const
  {
    throw std::runtime_error("cannot write " + _target.string() + ": "
                             + std::strerror(error));
  }

  std::filesystem::path _target, _path;
  int _fd;
  bool _moved = false;
};
} // namespace

std::map<std::string, std::string> Summary::library_versions()
{
#if defined(__clang__)
  const std::string compiler = __VERSION__;
#else
  const std::string compiler = "g++ " __VERSION__;
#endif
  return {{"mmale", MMALE_VERSION}, {"compiler", compiler}};
}

std::string Summary::commit_from_environment()
{
  const char* commit = std::getenv("MMALE_COMMIT");
  return commit and * commit ? commit : "unknown";
}

std::string to_json(const Summary& s)
{
  ordered_json out = {{"title", s.title},
                      {"outcome", s.outcome},
                      {"checks", list(s.checks)},
                      {"time", number(s.time)},
                      {"steps", s.steps},
                      {"rejected_steps", s.rejected},
                      {"newton_iterations", s.iterations},
                      {"remaps", s.remaps},
                      {"remaps_left_out", s.remaps_left_out},
                      {"remap_trouble", s.remap_trouble},
                      {"law", s.law},
                      {"initial_imbalance", number(s.initial_imbalance)},
                      {"resumed", s.resumed},
                      {"cells", s.cells},
                      {"nodes", s.nodes},
                      {"wall_seconds", number(s.wall_seconds)},
                      {"ranks", s.ranks},
                      {"commit", s.commit},
                      {"versions", s.versions},
                      {"ledger", list(s.ledger)},
                      {"timers", list(s.timers)},
                      {"scene", scene(s.scene)}};
  if (not s.data.empty())
    out["data"] = list(s.data);
  if (not s.water.empty())
  {
    ordered_json& water = out["water"];
    for (const auto& [name, value] : s.water)
      water[name] = number(value);
    water["recommended"] = s.water_recommended;
  }
  // Titles may hold bytes that are no UTF-8: they must not cost the summary.
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

void write_atomically(const std::filesystem::path& file, std::string_view text)
{
  Neighbour neighbour(file);
  neighbour.write(text);
  neighbour.move_to_target();
}
} // namespace mmale::output
