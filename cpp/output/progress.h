// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

/// How far a run is, for the one who waits.
///
/// On a terminal a bar with the time left; elsewhere a plain line every tenth
/// of the run or every 30 s, whichever comes first.
namespace mmale::output
{
/// What a finished step has to tell.
struct Step
{
  double time = 0;         ///< reached [s]
  double size = 0;         ///< time increment [s]
  std::int64_t number = 0; ///< accepted steps so far
  int iterations = 0;      ///< Newton iterations of this step
};

class Progress
{
public:
  enum class Style
  {
    bar,
    lines,
    quiet
  };

  /// Bar if standard error is a terminal, else lines; or quiet.
  static Style style(bool quiet);

  /// On standard error.
  /// @param[in] begin,end time of the run [s], begin < end
  Progress(double begin, double end, Style style);

  /// On any stream and by any clock, e.g. for tests.
  /// @param[in] width columns of the terminal
  /// @param[in] now   wall time [s]
  Progress(double begin, double end, Style style, std::ostream& out,
           std::function<int()> width, std::function<double()> now);

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Takes the bar off the screen, if `finish` was never called.
  ~Progress();

  /// What another run of the program has reached took none of our time.
  /// @param[in] step the last one
  void resume(const Step& step);

  void show(const Step& step);

  /// A message of its own line; the bar stays below it.
  void note(std::string_view message);

  /// Remove the bar and say how the run ended; the outcome is shown by
  /// `quiet` too unless it is "completed".
  void finish(std::string_view outcome);

private:
  double share(double time) const;
  std::string numbers(const Step& step, double share) const;
  void draw();
  void clear();

  double _begin, _end;
  Style _style;
  std::ostream& _out;
  std::function<int()> _width;
  std::function<double()> _now;
  double _started;   // wall time [s]
  double _first = 0; // share that was done when this run began
  double _shown;     // wall time of the last sign of life [s]
  int _tenth = 0;    // last tenth for which a line was written
  bool _on_screen = false;
  bool _finished = false;
  Step _step;
};

/// "42 s", "3 min 05 s", "2 h 07 min".
std::string duration(double seconds);
} // namespace mmale::output
