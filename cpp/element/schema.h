// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "element/test.h"
#include "scene/schema.h"

/// The keys of an element test, each named once (as scene/schema.h).
namespace mmale::scene
{
template <>
inline constexpr bool is_table<element::Initial> = true;
template <>
inline constexpr bool is_table<element::Data> = true;
template <>
inline constexpr bool is_table<element::Path> = true;
template <>
inline constexpr bool is_table<element::Solver> = true;
template <>
inline constexpr bool is_table<element::Test> = true;
} // namespace mmale::scene

namespace mmale::element
{
inline const std::vector<std::string> kinds = {
    "isotropic", "oedometric", "triaxial", "simple_shear", "free"};
enum Kind : std::size_t
{
  isotropic,
  oedometric,
  triaxial,
  simple_shear,
  free_path
};
inline const std::vector<std::string> holds = {"sigma_r", "p"};
inline const std::vector<std::string> drainages = {"drained", "undrained"};

template <class V>
void keys(V& v, Initial& i)
{
  v({"pressure", "Pa", "Isotropic effective stress, instead of sigma_a and k0.",
     scene::at_least(0)},
    i.pressure);
  v({"sigma_a", "Pa", "Axial effective stress.", scene::at_least(0)},
    i.sigma_a);
  v({"k0", "-", "Radial over axial effective stress.", scene::at_least(0)},
    i.k0);
  v({"void_ratio", "-",
     "Void ratio; by default what the material's own keys say.",
     scene::above(0)},
    i.void_ratio);
}

template <class V>
void keys(V& v, Data& d)
{
  v({"file",
     "",
     "CSV beside the test, its columns named as in curves.csv.",
     {},
     {},
     true},
    d.file);
  v({"x", "", "Column that is the abscissa; default the file's first."}, d.x);
}

template <class V>
void keys(V& v, Path& p)
{
  v({"name", "", "Name, also used on the command line."}, p.name);
  v({"kind", "", "What is held and what is driven.", {}, kinds, true}, p.kind);
  const auto only = [&](std::initializer_list<std::size_t> wanted, auto f)
  { v.only_with("kind", p.kind, kinds, wanted, f); };
  only({triaxial, simple_shear, free_path},
       [&]
       {
         v({"drainage",
            "",
            "Undrained: the volume is constant, stresses given are total.",
            {},
            drainages},
           p.drainage);
       });
  only({triaxial},
       [&]
       {
         v({"hold",
            "",
            "What stays besides sigma_r = sigma_t: both, or the mean pressure.",
            {},
            holds},
           p.hold);
       });
  only({isotropic},
       [&]
       {
         v({"pressure", "Pa", "Effective pressure."}, p.pressure);
         v({"eps_v", "-", "Volume strain."}, p.eps_v);
       });
  only({oedometric, triaxial, free_path},
       [&] { v({"eps_a", "-", "Axial strain, yy."}, p.eps_a); });
  only({free_path},
       [&]
       {
         v({"eps_r", "-", "Radial strain, xx."}, p.eps_r);
         v({"eps_t", "-", "Tangential strain, zz."}, p.eps_t);
       });
  only({simple_shear, free_path},
       [&] { v({"gamma", "-", "Shear strain, 2 eps_xy."}, p.gamma); });
  only({oedometric, triaxial, free_path},
       [&] { v({"sigma_a", "Pa", "Axial stress, yy."}, p.sigma_a); });
  only({free_path},
       [&]
       {
         v({"sigma_r", "Pa", "Radial stress, xx."}, p.sigma_r);
         v({"sigma_t", "Pa", "Tangential stress, zz."}, p.sigma_t);
       });
  only({simple_shear, free_path},
       [&] { v({"tau", "Pa", "Shear stress, xy."}, p.tau); });
  only({triaxial}, [&] { v({"q", "Pa", "Axial less radial stress."}, p.q); });
  only({isotropic, oedometric, triaxial, simple_shear},
       [&]
       {
         v({"cycles", "-",
            "Cycles, in quarters; the target is then an amplitude about the "
            "value at the start. 0: one way.",
            scene::at_least(0)},
           p.cycles);
       });
  v({"steps", "-", "Steps of the path, or of each cycle (a multiple of 4).",
     scene::at_least(1)},
    p.steps);
  v({"duration", "s", "Time that it takes; for laws that know rates.",
     scene::above(0)},
    p.duration);
}

template <class V>
void keys(V& v, Solver& s)
{
  v({"tolerance", "-", "To which stresses that are given are met.",
     scene::between(0, 1)},
    s.tolerance);
  v({"tangent", "", "Material tangent in Newton's matrix."}, s.tangent);
}

template <class V>
void keys(V& v, Test& t)
{
  v({"title", "", "One line for people."}, t.title);
  v({"material", "", "The material, as [material] or [material.NAME]."},
    t.material);
  v({"initial", "", "The sample before the first path."}, t.initial);
  v({"path", "", "Loadings, in order. Compression is positive."}, t.path);
  v({"data", "", "Measured points that the test is held against."}, t.data);
  v({"solver", "", "Knobs of the driver."}, t.solver);
}
} // namespace mmale::element
