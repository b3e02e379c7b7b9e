// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "drucker_prager.h"
#include "elastic.h"
#include "herschel_bulkley.h"
#include "hypoplastic.h"
#include "j2.h"
#include "mohr_coulomb.h"
#include "newtonian.h"
#include "rigid.h"
#include "scene/parameter.h"
#include "umat.h"
#include "void.h"
#include <span>
#include <variant>

namespace mmale::material
{
/// Every law. A new one is its file and its name here; the scene reader and
/// the conformance tests walk this list.
using AnyLaw =
    std::variant<Elastic, J2, DruckerPrager, MohrCoulomb, Hypoplastic,
                 Newtonian, HerschelBulkley, Rigid, Void, Umat>;

/// Names, parameters and ranges of all laws, for the scene reader.
std::vector<scene::LawInfo> law_infos();

/// A law filled from a scene that has no complaints left: defaults, then the
/// parameter set if one is named, then what is written.
///
/// @throws std::invalid_argument for an unknown law, set or parameter, or a
///         library that cannot be loaded
AnyLaw make_law(const scene::Material& material);

/// Numbers of a point's history, with water in its pores those of the water at
/// the end.
int num_history(const AnyLaw& law, bool water = false);

/// Names of these numbers; a tensor has four, ending in _xx, _yy, _zz, _xy.
std::vector<std::string> history_names(const AnyLaw& law, bool water = false);

/// Where the void ratio is in the history of a law; -1: it knows none.
int void_ratio_index(const AnyLaw& law);

/// Porosity of a point whose law knows its void ratio; else what is given.
/// @param[in] q the history of the point
double porosity(const AnyLaw& law, std::span<const double> q, double given);
} // namespace mmale::material
