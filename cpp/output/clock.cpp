// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/clock.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <stdexcept>

namespace mmale::output
{
namespace
{
double seconds(std::chrono::steady_clock::duration d)
{
  return std::chrono::duration<double>(d).count();
}

/// "1a law and assembly" is part of "1 lagrangian".
bool nested(std::string_view name)
{
  std::size_t digits = 0;
  while (digits < name.size()
         and std::isdigit(static_cast<unsigned char>(name[digits])))
    ++digits;
  return digits > 0 and digits < name.size()
         and std::isalpha(static_cast<unsigned char>(name[digits]));
}

std::string row(std::string_view name, double seconds, double share,
                std::string_view calls, std::string_view rate)
{
  std::array<char, 160> line;
  std::snprintf(line.data(), line.size(),
                "%-30.*s %10.3f %6.1f %% %9.*s %11.*s\n",
                static_cast<int>(name.size()), name.data(), seconds,
                100 * share, static_cast<int>(calls.size()), calls.data(),
                static_cast<int>(rate.size()), rate.data());
  return line.data();
}

std::string number(const char* format, double value)
{
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}
} // namespace

Clock::Clock() : _begin(Time::now())
{
  _timers.reserve(16);
}

Clock::Scope::Scope(Clock& clock, std::size_t timer)
    : _clock(clock), _timer(timer)
{
  Timer& t = _clock._timers[_timer];
  ++t.calls;
  if (t.open++ == 0)
    t.begin = Time::now();
}

Clock::Scope::~Scope()
{
  Timer& t = _clock._timers[_timer];
  if (--t.open == 0)
    t.sum += Time::now() - t.begin;
}

Clock::Scope Clock::scope(std::string_view name)
{
  // A dozen names: walking them is quicker than any map.
  std::size_t i = 0;
  while (i < _timers.size() and _timers[i].name != name)
    ++i;
  if (i == _timers.size())
    _timers.push_back({.name = std::string(name)});
  return Scope(*this, i);
}

double Clock::wall() const
{
  return seconds(Time::now() - _begin);
}

std::vector<Timing> Clock::timings(std::int64_t cells,
                                   const Reduce& reduce) const
{
  std::vector<Timer> timers = _timers;
  std::ranges::sort(timers, {}, &Timer::name);
  const Time::time_point now = Time::now();
  for (Timer& t : timers)
    if (t.open > 0)
      t.sum += now - t.begin;

  double wall = seconds(now - _begin);
  std::vector<double> sums(timers.size());
  std::ranges::transform(timers, sums.begin(),
                         [](const Timer& t) { return seconds(t.sum); });
  if (reduce)
  {
    const double n = static_cast<double>(timers.size());
    std::array<double, 3> head = {n, -n, wall};
    reduce(head);
    if (head[0] != -head[1])
      throw std::runtime_error("the ranks timed different steps");
    wall = head[2];
    reduce(sums);
  }

  std::vector<Timing> out;
  for (std::size_t i = 0; i < timers.size(); ++i)
  {
    const double calls = static_cast<double>(timers[i].calls);
    out.push_back(
        {.name = timers[i].name,
         .seconds = sums[i],
         .share = wall > 0 ? sums[i] / wall : 0,
         .calls = timers[i].calls,
         .cells_per_second =
             sums[i] > 0 ? static_cast<double>(cells) * calls / sums[i] : 0});
  }
  return out;
}

void Clock::add(std::span<const Timing> before, double wall)
{
  const auto ticks = [](double s)
  {
    return std::chrono::duration_cast<Time::duration>(
        std::chrono::duration<double>(s));
  };
  _begin -= ticks(wall);
  for (const Timing& timing : before)
  {
    const auto at = std::ranges::find(_timers, timing.name, &Timer::name);
    Timer& t = at == _timers.end() ? _timers.emplace_back() : *at;
    t.name = timing.name;
    t.sum += ticks(timing.seconds);
    t.calls += timing.calls;
  }
}

std::string table(std::span<const Timing> timings, double wall)
{
  std::array<char, 160> head;
  std::snprintf(head.data(), head.size(), "%-30s %10s %8s %9s %11s\n", "step",
                "seconds", "share", "calls", "cells/s");
  std::string out = head.data();
  double timed = 0;
  for (const Timing& t : timings)
  {
    const bool part = nested(t.name);
    if (not part)
      timed += t.seconds;
    out += row((part ? "  " : "") + t.name, t.seconds, t.share,
               std::to_string(t.calls), number("%.3g", t.cells_per_second));
  }
  const double other = std::max(0.0, wall - timed);
  out += row("other", other, wall > 0 ? other / wall : 0, "", "");
  out += row("whole run", wall, 1, "", "");
  return out;
}
} // namespace mmale::output
