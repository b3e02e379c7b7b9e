// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/fields.h"

#include "compat.h"
#include "output/on_root.h"
#include "output/summary.h"
#include <algorithm>
#include <cassert>
#include <dolfinx/fem/Function.h>
#include <dolfinx/io/VTKFile.h>
#include <fstream>
#include <mpi.h>
#include <stdexcept>
#include <vector>

namespace mmale::output
{
namespace
{
using Function = dolfinx::fem::Function<double>;
using Space = dolfinx::fem::FunctionSpace<double>;
using Mesh = dolfinx::mesh::Mesh<double>;

/// Place in the file's 3 x 3 tensor of each component xx yy zz xy.
constexpr std::array<std::array<int, 2>, 4> tensor_places = {
    {{0, -1}, {4, -1}, {8, -1}, {1, 3}}};

/// A field as it goes to the file.
struct Entry
{
  std::string name;
  Location location;
  int components;
  std::shared_ptr<Function> function;
};

std::shared_ptr<Function> make_function(std::shared_ptr<Mesh> mesh,
                                        const NamedField& field)
{
  std::vector<std::size_t> shape;
  if (field.components == 2)
    shape = {2};
  else if (field.components == 4)
    shape = {3, 3};
  else if (field.components != 1)
    throw std::runtime_error("field \"" + field.name + "\" has "
                             + std::to_string(field.components)
                             + " components; 1, 2 and 4 can be written");
  const auto space = std::make_shared<const Space>(compat::lagrange_space(
      mesh, field.location == Location::nodal ? 1 : 0, shape));
  auto function = std::make_shared<Function>(space);
  function->name = field.name;
  return function;
}

void copy(const NamedField& field, const Function& function,
          std::span<double> to)
{
  const auto& dofmap = *function.function_space()->dofmap();
  const std::size_t n = static_cast<std::size_t>(
      dofmap.index_map->size_local() + dofmap.index_map->num_ghosts());
  const auto components = static_cast<std::size_t>(field.components);
  if (field.values.size() != n * components)
    throw std::runtime_error("field \"" + field.name + "\" has "
                             + std::to_string(field.values.size())
                             + " values for " + std::to_string(n) + " times "
                             + std::to_string(components));
  // The dofs of a DG0 space need not be numbered as the cells.
  const std::size_t width = to.size() / n;
  const auto cells = dofmap.map();
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::size_t dof = field.location == Location::cell
                                ? static_cast<std::size_t>(cells(i, 0))
                                : i;
    const double* from = field.values.data() + i * components;
    double* at = to.data() + dof * width;
    if (field.components < 4)
      std::copy_n(from, components, at);
    else
      for (std::size_t c = 0; c < tensor_places.size(); ++c)
        for (const int place : tensor_places[c])
          if (place >= 0)
            at[place] = from[c];
  }
}

/// Files of an older run, perhaps with more ranks or more times.
void remove_older(const std::filesystem::path& folder)
{
  for (const auto& entry : std::filesystem::directory_iterator(folder))
  {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("fields") and name.ends_with("vtu"))
      std::filesystem::remove(entry.path());
  }
}

/// The file writer tells nothing of a full disk: a whole file has its end tag.
/// @return empty, or what is wrong
std::string broken(const std::filesystem::path& file)
{
  constexpr std::string_view tag = "</VTKFile>";
  constexpr std::streamoff room = 20; // the tag and a line break
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in ? std::streamoff(in.tellg()) : 0;
  std::string tail(static_cast<std::size_t>(std::min(size, room)), ' ');
  in.seekg(-static_cast<std::streamoff>(tail.size()), std::ios::end);
  in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  if (in and tail.find(tag) != std::string::npos)
    return {};
  return "cannot write " + file.string() + " whole: is the disk full?";
}

/// Throws on all ranks if any has something to say.
void agree(MPI_Comm comm, const std::string& complaint,
           const std::string& elsewhere)
{
  int failed = complaint.empty() ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, comm);
  if (failed)
    throw std::runtime_error(complaint.empty() ? elsewhere : complaint);
}
} // namespace

struct Fields::Impl
{
  std::shared_ptr<Mesh> mesh;
  std::filesystem::path file;
  std::unique_ptr<dolfinx::io::VTKFile> vtk;
  std::vector<Entry> entries;
  std::map<std::string, FieldInfo> info;
  int written = 0; // number of the next output

  int rank() const
  {
    int out = 0;
    MPI_Comm_rank(mesh->comm(), &out);
    return out;
  }

  /// This rank's part of the last output, as the file writer names it.
  std::filesystem::path piece() const
  {
    std::string number = std::to_string(written - 1);
    number.insert(0, 6 - std::min<std::size_t>(6, number.size()), '0');
    return file.parent_path()
           / ("fields_p" + std::to_string(rank()) + "_" + number + ".vtu");
  }

  void create(std::span<const NamedField> fields)
  {
    std::vector<Entry> made; // nothing is kept of a list that is refused
    for (const NamedField& f : fields)
      made.push_back(
          {f.name, f.location, f.components, make_function(mesh, f)});
    entries = std::move(made);
    for (const NamedField& f : fields)
      info[f.name] = {.unit = f.unit};
  }

  void fill(std::span<const NamedField> fields)
  {
    if (fields.size() != entries.size())
      throw std::runtime_error("the list of fields has changed on the way");
    for (std::size_t i = 0; i < fields.size(); ++i)
    {
      const NamedField& f = fields[i];
      const Entry& e = entries[i];
      if (f.name != e.name or f.location != e.location
          or f.components != e.components)
        throw std::runtime_error("field \"" + f.name
                                 + "\" has changed on the way");
      copy(f, *e.function, e.function->x()->mutable_array());
    }
  }
};

Fields::Fields(std::shared_ptr<Mesh> mesh, std::filesystem::path folder)
    : _impl(std::make_unique<Impl>())
{
  _impl->mesh = std::move(mesh);
  _impl->file = folder / "fields.pvd";
  // The field writer reports no failure of its files: try the place first.
  on_root(_impl->mesh->comm(),
          [&]
          {
            std::filesystem::create_directories(folder);
            remove_older(folder);
            write_atomically(_impl->file, "");
          });
  _impl->vtk = std::make_unique<dolfinx::io::VTKFile>(_impl->mesh->comm(),
                                                      _impl->file, "w");
}

Fields::~Fields() = default;
Fields::Fields(Fields&&) noexcept = default;
Fields& Fields::operator=(Fields&&) noexcept = default;

void Fields::write(double t, std::span<const NamedField> fields)
{
  MPI_Comm comm = _impl->mesh->comm();
  const std::string elsewhere = "fields could not be written on another rank";
  if (_impl->entries.empty())
    _impl->create(fields);
  std::string complaint;
  try
  {
    _impl->fill(fields);
  }
  catch (const std::runtime_error& error)
  {
    complaint = error.what();
  }
  agree(comm, complaint, elsewhere);

  std::vector<std::reference_wrapper<const Function>> list;
  for (const Entry& e : _impl->entries)
    list.emplace_back(*e.function);
  if (list.empty())
    _impl->vtk->write(*_impl->mesh, t);
  else
    _impl->vtk->write<double>(list, t);
  _impl->vtk->flush();
  ++_impl->written;
  complaint = broken(_impl->piece());
  if (complaint.empty() and _impl->rank() == 0)
    complaint = broken(_impl->file);
  agree(comm, complaint, elsewhere);
}

const std::map<std::string, FieldInfo>& Fields::info() const
{
  return _impl->info;
}
} // namespace mmale::output
