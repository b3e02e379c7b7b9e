// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "output/pictures.h"
#include <cstdint>
#include <dolfinx/mesh/Mesh.h>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// Fields for ParaView on the moving mesh: nodal and cell data in one set of
/// files, `fields.pvd` and one .vtu a rank and time.
namespace mmale::output
{
/// Where the values of a field live.
enum class Location
{
  nodal, ///< local nodes, owned then ghosts, in the order of a P1 space
  cell   ///< local cells, owned then ghosts, in the topology's order
};

/// A field as the solver has it.
///
/// Components: 1 scalar; 2 vector x y; 4 symmetric tensor xx yy zz xy (rr zz
/// θθ rz). Files hold vectors with 3 and tensors with 9 components.
struct NamedField
{
  std::string name = {};
  Location location = Location::cell;
  int components = 1;
  std::span<const double> values =
      {};                ///< shape (local nodes or cells, components)
  std::string unit = {}; ///< for colour bars; empty: a plain number
};

/// An output of fields that is on the disk.
struct FieldOutput
{
  double time = 0;        ///< [s]
  std::int64_t begin = 0; ///< number of the first output by the same program
};

class Fields
{
public:
  /// Collective. The folder is made if missing; files of outputs other than
  /// the earlier ones are removed.
  ///
  /// @param[in] mesh   triangles of degree 1; its geometry is read anew at
  /// each `write`
  /// @param[in] folder of the run
  /// @param[in] earlier outputs of this run by another call of the program,
  /// which stay
  /// @throws std::runtime_error on all ranks if the folder cannot be written
  Fields(std::shared_ptr<dolfinx::mesh::Mesh<double>> mesh,
         std::filesystem::path folder, std::vector<FieldOutput> earlier = {});

  ~Fields();
  Fields(Fields&&) noexcept;
  Fields& operator=(Fields&&) noexcept;

  /// Write fields and the mesh as it stands. Collective.
  ///
  /// The first call fixes names, locations and components; ghosts' values are
  /// written as given.
  ///
  /// @param[in] t      time [s]
  /// @param[in] fields same list on every rank and at every call
  /// @throws std::runtime_error on all ranks naming the file and the cause
  void write(double t, std::span<const NamedField> fields);

  /// All outputs so far, the earlier ones too.
  const std::vector<FieldOutput>& outputs() const;

  /// Units of what was written, for the pictures.
  const std::map<std::string, FieldInfo>& info() const;

private:
  struct Impl;
  std::unique_ptr<Impl> _impl;
};
} // namespace mmale::output
