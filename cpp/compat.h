// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <basix/finite-element.h>
#include <dolfinx/common/version.h>
#include <dolfinx/fem/CoordinateElement.h>
#include <dolfinx/fem/FiniteElement.h>
#include <dolfinx/fem/FunctionSpace.h>
#include <dolfinx/fem/utils.h>
#include <dolfinx/la/Vector.h>
#include <dolfinx/mesh/utils.h>
#include <memory>
#include <span>
#include <type_traits>
#include <ufcx.h>
#include <vector>

/// What differs between DOLFINx 0.9, 0.10 and 0.11, and nothing else.
///
/// CONTRIBUTING.md says how it is checked against the headers of each.
namespace mmale::compat
{
namespace dx = dolfinx;

/// A generated kernel: (A, w, c, x, facet, permutation), and from 0.10 on a
/// pointer to whatever a hand-written kernel may want.
using Kernel = decltype(ufcx_integral::tabulate_tensor_float64);

/// Call the kernel of an integral or of an expression.
///
/// @param[in,out] A what the kernel adds to
/// @param[in]     w,c,x packed coefficients, constants, vertices (3, 3) [m]
/// @param[in]     facet local facet, or nullptr for cells
template <class K>
void call(K kernel, double* A, const double* w, const double* c,
          const double* x, const int* facet)
{
  if constexpr (std::is_invocable_v<K, double*, const double*, const double*,
                                    const double*, const int*,
                                    const std::uint8_t*, void*>)
    kernel(A, w, c, x, facet, nullptr, nullptr);
  else
    kernel(A, w, c, x, facet, nullptr);
}

/// Lagrange space on triangles.
///
/// @param[in] degree 1 (nodal) or 0 (one value a cell, discontinuous)
/// @param[in] shape  of a value; empty for a scalar
inline dx::fem::FunctionSpace<double>
lagrange_space(std::shared_ptr<dx::mesh::Mesh<double>> mesh, int degree,
               const std::vector<std::size_t>& shape = {})
{
  const auto element = basix::create_element<double>(
      basix::element::family::P, basix::cell::type::triangle, degree,
      basix::element::lagrange_variant::gll_warped,
      basix::element::dpc_variant::unset, degree == 0);
#if DOLFINX_VERSION_MINOR >= 10
  using Element = dx::fem::FiniteElement<double>;
  return dx::fem::create_functionspace<double>(
      mesh, shape.empty() ? std::make_shared<const Element>(element)
                          : std::make_shared<const Element>(element, shape));
#else
  return dx::fem::create_functionspace<double>(mesh, element, shape);
#endif
}

/// DOLFINx's own partitioner; cells meet in pairs at their facets.
inline dx::mesh::CellPartitionFunction
cell_partitioner(dx::mesh::GhostMode mode)
{
#if DOLFINX_VERSION_MINOR >= 11
  return dx::mesh::create_cell_partitioner(mode, 2);
#else
  return dx::mesh::create_cell_partitioner(mode);
#endif
}

/// Mesh of straight triangles, given on any ranks and distributed.
///
/// @param[in] cells vertices, shape (n, 3)
/// @param[in] x     points, shape (m, 2) [m]
inline dx::mesh::Mesh<double>
create_mesh(MPI_Comm comm, std::span<const std::int64_t> cells,
            const std::vector<double>& x,
            const dx::mesh::CellPartitionFunction& partitioner)
{
  const dx::fem::CoordinateElement<double> straight(
      dx::mesh::CellType::triangle, 1);
  const std::array<std::size_t, 2> shape = {x.size() / 2, 2};
#if DOLFINX_VERSION_MINOR >= 11
  return dx::mesh::create_mesh(comm, comm, cells, straight, comm, x, shape,
                               partitioner, 2);
#else
  return dx::mesh::create_mesh(comm, comm, cells, straight, comm, x, shape,
                               partitioner);
#endif
}
} // namespace mmale::compat
