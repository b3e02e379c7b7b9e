// SPDX-License-Identifier: LGPL-3.0-or-later
//
// METHOD 2: colours of nodes, so that no two nodes of a colour share a cell.
// Nodes of one colour may move in any order with the same result. The colours
// depend on global numbers alone: the same on any number of ranks.
#pragma once

#include "remap/host.h"
#include "remap/mesh.h"

#include <vector>

namespace remap
{
/// Colours of all local nodes, from 0. Collective.
///
/// A node takes the smallest colour that no neighbour of higher priority has;
/// priority is a hash of the global number. The result does not depend on the
/// order in which nodes get their turn.
/// @source Jones & Plassmann (1993)
std::vector<std::int32_t> colour_nodes(const Mesh& mesh, const Host& host);

/// Mixed bits of a number; a bijection, so different numbers never tie.
constexpr std::uint64_t hash(std::uint64_t id)
{
  // Finaliser of splitmix64, Steele, Lea & Flood (2014).
  id += 0x9e3779b97f4a7c15u;
  id = (id ^ (id >> 30)) * 0xbf58476d1ce4e5b9u;
  id = (id ^ (id >> 27)) * 0x94d049bb133111ebu;
  return id ^ (id >> 31);
}
} // namespace remap
