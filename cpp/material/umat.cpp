// SPDX-License-Identifier: LGPL-3.0-or-later
#include "umat.h"

#include <algorithm>
#include <cmath>
#include <dlfcn.h>
#include <filesystem>
#include <format>

namespace mmale::material
{
namespace
{
/// The routine as a Fortran compiler lays it out: all by address, the length
/// of the text last and by value.
using Routine = void (*)(
    double* stress, double* statev, double* ddsdde, double* sse, double* spd,
    double* scd, double* rpl, double* ddsddt, double* drplde, double* drpldt,
    const double* stran, const double* dstran, const double* time,
    const double* dtime, const double* temp, const double* dtemp,
    const double* predef, const double* dpred, const char* cmname,
    const int* ndi, const int* nshr, const int* ntens, const int* nstatv,
    const double* props, const int* nprops, const double* coords,
    const double* drot, double* pnewdt, const double* celent,
    const double* dfgrd0, const double* dfgrd1, const int* noel, const int* npt,
    const int* layer, const int* kspt, const int* jstep, const int* kinc,
    std::size_t cmname_length);

/// Where things are in the history: strain, time, then STATEV.
constexpr std::size_t at_time = 4, at_states = 5;

/// What a call brings back.
struct Answer
{
  Voigt sigma;
  Voigt2 C;
  double pnewdt;
};

/// One call; STATEV is advanced in `q`.
Answer call(const Umat& law, const Voigt& sigma, const Voigt& strain, double dt,
            std::span<double> q)
{
  // Routines write into what is theirs to read: they get copies.
  static thread_local std::vector<double> props, states;
  props = law.props;
  props.resize(std::max<std::size_t>(1, props.size()), 0);
  states.assign(q.begin() + at_states, q.end());
  states.resize(std::max<std::size_t>(1, states.size()), 0);
  Answer out{sigma, Voigt2::Zero(), 1};
  Voigt before(q[0], q[1], q[2], 2 * q[3]), increment = strain;
  std::array<double, 2> time = {q[at_time], q[at_time]};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity(), start = turn, end = turn;
  end.diagonal() += strain.head<3>();
  end(0, 1) = end(1, 0) = strain[3] / 2;
  double sse = 0, spd = 0, scd = 0, rpl = 0, drpldt = 0;
  Voigt ddsddt = Voigt::Zero(), drplde = Voigt::Zero();
  double temp = 0, dtemp = 0, predef = 0, dpred = 0, celent = 1;
  std::array<double, 3> coords = {};
  int ndi = 3, nshr = 1, ntens = 4, noel = 1, npt = 1, layer = 1, kspt = 1;
  auto nstatv = static_cast<int>(q.size() - at_states);
  auto nprops = static_cast<int>(law.props.size());
  // Newer releases hand over JSTEP(4) for KSTEP: static, with large strains.
  std::array<int, 4> jstep = {1, 1, 1, 0};
  int kinc = q[at_time] > 0 ? 2 : 1;
  std::array<char, 80> name;
  name.fill(' ');
  std::ranges::copy(std::string_view("MMALE"), name.begin());
  reinterpret_cast<Routine>(law.routine)(
      out.sigma.data(), states.data(), out.C.data(), &sse, &spd, &scd, &rpl,
      ddsddt.data(), drplde.data(), &drpldt, before.data(), increment.data(),
      time.data(), &dt, &temp, &dtemp, &predef, &dpred, name.data(), &ndi,
      &nshr, &ntens, &nstatv, props.data(), &nprops, coords.data(), turn.data(),
      &out.pnewdt, &celent, start.data(), end.data(), &noel, &npt, &layer,
      &kspt, jstep.data(), &kinc, name.size());
  std::copy_n(states.begin(), q.size() - at_states, q.begin() + at_states);
  return out;
}

bool finite(std::span<const double> numbers)
{
  return std::ranges::all_of(numbers,
                             [](double x) { return std::isfinite(x); });
}
} // namespace

const std::array<Parameter<Umat>, 2> Umat::parameters{{
    {"states", "-", &Umat::states, scene::from_to(0, 10000),
     "Number of STATEV"},
    {"density", "kg/m3", &Umat::density, scene::at_least(0), "mass density"},
}};

const std::array<TextParameter<Umat>, 1> Umat::texts{{
    {"library", &Umat::library, true,
     "Shared library with UMAT, relative to the scene"},
}};

const std::array<ListParameter<Umat>, 2> Umat::lists{{
    {"props", &Umat::props, "PROPS, in SI units"},
    {"initial_states", &Umat::initial_states,
     "STATEV at the start, all of them; by default zeros"},
}};

std::string Umat::open()
{
  std::error_code error;
  // with a slash, so that it is looked for there and nowhere else
  const std::filesystem::path file =
      std::filesystem::absolute(std::filesystem::path(folder) / library, error);
  if (not std::filesystem::exists(file, error))
    return "library: no such file " + file.string();
  void* handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (not handle)
    return std::string("library: cannot be loaded: ") + ::dlerror();
  routine = reinterpret_cast<void (*)()>(::dlsym(handle, "umat_"));
  return routine ? std::string()
                 : "library: " + file.string()
                       + " has no symbol umat_ (Fortran's SUBROUTINE UMAT)";
}

std::vector<std::string> Umat::complaints() const
{
  std::vector<std::string> out;
  if (states != std::floor(states))
    out.push_back(std::format("states: must be a whole number, is {}", states));
  if (not initial_states.empty()
      and static_cast<double>(initial_states.size()) != states)
    out.push_back(std::format("initial_states: has {} numbers, states is {}",
                              initial_states.size(), states));
  Umat loaded = *this;
  if (std::string trouble = loaded.open(); not trouble.empty())
    out.push_back(std::move(trouble));
  return out;
}

std::vector<HistoryField> Umat::history() const
{
  std::vector<HistoryField> fields = {{"total_strain", 4}, {"total_time"}};
  for (int i = 1; i <= static_cast<int>(states); ++i)
    fields.push_back({"state_" + std::to_string(i)});
  return fields;
}

void Umat::begin(const Start&, std::span<double> q) const
{
  std::ranges::fill(q, 0);
  std::ranges::copy(initial_states, q.begin() + at_states);
}

Moduli Umat::moduli(const Point& start, double dt) const
{
  static thread_local std::vector<double> q;
  q.assign(start.q.begin(), start.q.end());
  const Voigt one(1, 1, 1, 0);
  const Voigt2 C = call(*this, start.s - start.p * one, Voigt::Zero(), dt, q).C;
  const double largest = C.cwiseAbs().maxCoeff();
  // A routine may have no tangent for no strain: then its size must do.
  const double fallback =
      std::isfinite(largest) and largest > 0 ? largest / 3 : 1;
  const auto sound = [fallback](double modulus)
  { return std::isfinite(modulus) and modulus > 0 ? modulus : fallback; };
  return {sound(C(3, 3)), sound(C.topLeftCorner<3, 3>().sum() / 9)};
}

double Umat::admit(Eigen::Ref<Voigt> s, double& p, std::span<double> q) const
{
  static thread_local std::vector<double> after;
  after.assign(q.begin(), q.end());
  const Voigt one(1, 1, 1, 0);
  const Voigt sigma = s - p * one;
  const Answer out = call(*this, sigma, Voigt::Zero(), 0, after);
  if (out.pnewdt < 1 or not out.sigma.allFinite() or not finite(after))
    return 0;
  const double size = norm(sigma), cut = norm(sigma - out.sigma);
  std::ranges::copy(after, q.begin());
  p = -out.sigma.head<3>().sum() / 3;
  s = out.sigma + p * one;
  return size > 0 ? std::min(1.0, cut / size) : 0;
}

Outcome Umat::update(const Point& start, const Strain& step, TangentKind,
                     std::span<double> q, Response& answer) const
{
  const Voigt one(1, 1, 1, 0);
  const Voigt strain = step.de + step.theta / 3 * one;
  const Answer out = call(*this, start.s - start.p * one, strain, step.dt, q);
  for (std::size_t i = 0; i < 3; ++i)
    q[i] += strain[static_cast<Eigen::Index>(i)];
  q[3] += strain[3] / 2;
  q[at_time] += step.dt;
  if (out.pnewdt < 1 or not out.sigma.allFinite() or not out.C.allFinite()
      or not finite(q))
    return Outcome::reduce_step;
  answer = {};
  split(out.sigma, out.C, answer);
  return Outcome::ok;
}
} // namespace mmale::material
