// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <basix/finite-element.h>
#include <dolfinx/fem/FunctionSpace.h>
#include <dolfinx/fem/utils.h>
#include <memory>
#include <vector>

namespace mmale::output
{
/// A Lagrange space on triangles, as the field writer wants it.
///
/// @param[in] degree 1 (nodal) or 0 (one value a cell, discontinuous)
/// @param[in] shape  of a value; empty for a scalar
inline dolfinx::fem::FunctionSpace<double>
lagrange_space(std::shared_ptr<dolfinx::mesh::Mesh<double>> mesh, int degree,
               const std::vector<std::size_t>& shape = {})
{
  const auto element = basix::create_element<double>(
      basix::element::family::P, basix::cell::type::triangle, degree,
      basix::element::lagrange_variant::gll_warped,
      basix::element::dpc_variant::unset, degree == 0);
  return dolfinx::fem::create_functionspace<double>(mesh, element, shape);
}
} // namespace mmale::output
