// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Timers, one for each numbered step of METHOD.md and of the same name.
///
/// In: scopes opened around the steps. Out: seconds, calls, share of the wall
/// time. A parent's time contains that of the steps nested in it ("1
/// lagrangian" that of "1a law and assembly").
namespace mmale::output
{
/// What one timer has seen.
struct Timing
{
  std::string name = {};
  double seconds = 0; ///< [s]
  double share = 0;   ///< of the wall time of the run [-]
  std::int64_t calls = 0;
  double cells_per_second = 0; ///< cells * calls / seconds [1/s]
};

/// Stops the time of named steps.
class Clock
{
public:
  /// Largest value over the ranks, for each number, in place.
  using Reduce = std::function<void(std::span<double>)>;

  /// Counts while it lives.
  class Scope
  {
  public:
    Scope(Clock& clock, std::size_t timer);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    Clock& _clock;
    std::size_t _timer;
  };

  Clock();

  /// Time the block in which the returned object lives.
  ///
  /// A name that is open already counts a call and no second time. On every
  /// rank the same names must be used, in any order.
  ///
  /// @param[in] name step of METHOD.md, e.g. "1a law and assembly"
  [[nodiscard]] Scope scope(std::string_view name);

  /// Seconds since the clock was made [s].
  double wall() const;

  /// All timers that were called, sorted by name.
  ///
  /// Collective if `reduce` is: seconds are then the slowest rank's.
  ///
  /// @param[in] cells  cells of the whole mesh
  /// @param[in] reduce maximum over the ranks; empty: this rank alone
  /// @throws std::runtime_error on all ranks if their timers differ in number
  std::vector<Timing> timings(std::int64_t cells,
                              const Reduce& reduce = {}) const;

  /// Go on from what another run of the program has timed.
  /// @param[in] wall [s]
  void add(std::span<const Timing> before, double wall);

private:
  using Time = std::chrono::steady_clock;

  struct Timer
  {
    std::string name;
    Time::duration sum = {};
    Time::time_point begin = {};
    std::int64_t calls = 0;
    int open = 0; // scopes of this name that live
  };

  std::vector<Timer> _timers;
  Time::time_point _begin;
};

/// The table that ends a run: seconds, share, calls, cells/s for each step.
///
/// @param[in] wall wall time of the run [s]; the share not timed is "other"
std::string table(std::span<const Timing> timings, double wall);
} // namespace mmale::output
