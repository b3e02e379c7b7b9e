// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/progress.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sys/ioctl.h>
#include <unistd.h>

namespace mmale::output
{
namespace
{
constexpr double redraw = 0.1; // [s] a quicker bar is not seen, only paid for
constexpr double silence = 30; // [s] longest between two plain lines
constexpr int bar_max = 40;    // [columns]

double steady_seconds()
{
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

int terminal_width()
{
  winsize size = {};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 or size.ws_col == 0)
    return 80;
  return size.ws_col;
}

template <class... A>
std::string format(const char* text, A... values)
{
  std::array<char, 200> out;
  std::snprintf(out.data(), out.size(), text, values...);
  return out.data();
}
} // namespace

std::string duration(double seconds)
{
  const long s = std::lround(std::clamp(seconds, 0.0, 3.6e8));
  if (s < 60)
    return format("%ld s", s);
  if (s < 3600)
    return format("%ld min %02ld s", s / 60, s % 60);
  return format("%ld h %02ld min", s / 3600, s % 3600 / 60);
}

Progress::Style Progress::style(bool quiet)
{
  if (quiet)
    return Style::quiet;
  return ::isatty(STDERR_FILENO) ? Style::bar : Style::lines;
}

Progress::Progress(double begin, double end, Style style)
    : Progress(begin, end, style, std::cerr, terminal_width, steady_seconds)
{
}

Progress::Progress(double begin, double end, Style style, std::ostream& out,
                   std::function<int()> width, std::function<double()> now)
    : _begin(begin), _end(end), _style(style), _out(out),
      _width(std::move(width)), _now(std::move(now)), _started(_now()),
      _shown(_started)
{
}

Progress::~Progress()
{
  if (not _finished)
    clear();
}

double Progress::share(double time) const
{
  // Not finite for an empty run, which is done as soon as it starts.
  const double x = (time - _begin) / (_end - _begin);
  return std::isfinite(x) ? std::clamp(x, 0.0, 1.0) : 1.0;
}

std::string Progress::numbers(const Step& step, double share) const
{
  std::string out =
      format("t %.4g s  dt %.3g s  step %lld  Newton %d", step.time, step.size,
             static_cast<long long>(step.number), step.iterations);
  const double spent = _now() - _started;
  if (share > _first and share < 1)
    out += "  left " + duration(spent * (1 - share) / (share - _first));
  return out;
}

void Progress::resume(const Step& step)
{
  _step = step;
  _first = share(step.time);
  _tenth = static_cast<int>(10 * _first + 1e-9);
}

void Progress::show(const Step& step)
{
  _step = step;
  const double now = _now();
  if (_style == Style::bar)
  {
    if (not _on_screen or now - _shown >= redraw or step.time >= _end)
      draw();
  }
  else if (_style == Style::lines)
  {
    const double x = share(step.time);
    const int tenth = static_cast<int>(10 * x + 1e-9);
    if (tenth > _tenth or now - _shown >= silence)
    {
      _tenth = tenth;
      _shown = now;
      _out << format("%3.0f %%  ", 100 * x) << numbers(step, x) << std::endl;
    }
  }
}

void Progress::draw()
{
  const double x = share(_step.time);
  const std::string text = numbers(_step, x);
  const int width = _width();
  // " 42 % [" and "] " around the bar; a narrow terminal has no bar.
  const int room = width - 10 - static_cast<int>(text.size());
  std::string line = format("%3.0f %% ", 100 * x);
  if (room >= 5)
  {
    const int length = std::min(room, bar_max);
    const int full = static_cast<int>(x * length);
    line += '[' + std::string(static_cast<std::size_t>(full), '=')
            + std::string(static_cast<std::size_t>(length - full), ' ') + "] ";
  }
  line += text;
  // A line that wraps could not be taken back.
  line.resize(
      std::min(line.size(), static_cast<std::size_t>(std::max(width - 1, 1))));
  _out << '\r' << line << "\x1b[K" << std::flush;
  _on_screen = true;
  _shown = _now();
}

void Progress::clear()
{
  if (_on_screen)
    _out << "\r\x1b[K" << std::flush;
  _on_screen = false;
}

void Progress::note(std::string_view message)
{
  if (_style == Style::quiet)
    return;
  const bool again = _on_screen;
  clear();
  _out << message << std::endl;
  if (again)
    draw();
}

void Progress::finish(std::string_view outcome)
{
  clear();
  _finished = true;
  if (_style == Style::quiet and outcome == "completed")
    return;
  _out << outcome
       << format(" at t %.4g s after %lld steps, ", _step.time,
                 static_cast<long long>(_step.number))
       << duration(_now() - _started) << std::endl;
}
} // namespace mmale::output
