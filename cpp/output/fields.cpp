// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/fields.h"

#include "compat.h"
#include "output/on_root.h"
#include "output/summary.h"
#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
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

/// The writer counts from 0 in each call of the program: files of a resumed
/// run bear the number that it began with.
std::string stem(std::int64_t begin)
{
  return begin == 0 ? "fields" : "fields_" + std::to_string(begin);
}

/// A number as the file writer has it in names.
std::string counter(std::size_t n)
{
  std::string out = std::to_string(n);
  out.insert(0, 6 - std::min<std::size_t>(6, out.size()), '0');
  return out;
}

/// Files of an older run, perhaps with more ranks or more times.
void remove_others(const std::filesystem::path& folder,
                   std::span<const FieldOutput> kept)
{
  for (const auto& entry : std::filesystem::directory_iterator(folder))
  {
    const std::string name = entry.path().filename().string();
    if (not name.starts_with("fields") or not name.ends_with("vtu"))
      continue;
    bool keep = false;
    for (std::size_t i = 0; i < kept.size() and not keep; ++i)
    {
      const auto first = static_cast<std::size_t>(kept[i].begin);
      const std::string s = stem(kept[i].begin), c = counter(i - first);
      keep =
          name == s + c + ".pvtu"
          or (name.starts_with(s + "_p") and name.ends_with("_" + c + ".vtu"));
    }
    if (not keep)
      std::filesystem::remove(entry.path());
  }
}

/// The series as ParaView reads it.
std::string pvd(std::span<const FieldOutput> outputs)
{
  std::string out = "<?xml version=\"1.0\"?>\n"
                    "<VTKFile type=\"Collection\" version=\"0.1\">\n"
                    "  <Collection>\n";
  for (std::size_t i = 0; i < outputs.size(); ++i)
  {
    const auto& [time, begin] = outputs[i];
    std::array<char, 32> text;
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), time).ptr;
    out += "    <DataSet timestep=\"" + std::string(text.data(), end)
           + "\" part=\"0\" file=\"" + stem(begin)
           + counter(i - static_cast<std::size_t>(begin)) + ".pvtu\" />\n";
  }
  return out + "  </Collection>\n</VTKFile>\n";
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
  std::filesystem::path folder, file;
  std::unique_ptr<dolfinx::io::VTKFile> vtk;
  std::vector<Entry> entries;
  std::map<std::string, FieldInfo> info;
  std::vector<FieldOutput> outputs;
  std::int64_t begin = 0; // number of the first one by this call

  int rank() const
  {
    int out = 0;
    MPI_Comm_rank(mesh->comm(), &out);
    return out;
  }

  /// This rank's part of the last output, as the file writer names it.
  std::filesystem::path piece() const
  {
    const auto n = outputs.size() - 1 - static_cast<std::size_t>(begin);
    return folder
           / (stem(begin) + "_p" + std::to_string(rank()) + "_" + counter(n)
              + ".vtu");
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

Fields::Fields(std::shared_ptr<Mesh> mesh, std::filesystem::path folder,
               std::vector<FieldOutput> earlier)
    : _impl(std::make_unique<Impl>())
{
  _impl->mesh = std::move(mesh);
  _impl->folder = folder;
  _impl->file = folder / "fields.pvd";
  _impl->begin = static_cast<std::int64_t>(earlier.size());
  _impl->outputs = std::move(earlier);
  // The field writer reports no failure of its files: try the place first.
  on_root(_impl->mesh->comm(),
          [&]
          {
            std::filesystem::create_directories(folder);
            remove_others(folder, _impl->outputs);
            write_atomically(_impl->file, pvd(_impl->outputs));
          });
  _impl->vtk = std::make_unique<dolfinx::io::VTKFile>(
      _impl->mesh->comm(), folder / (stem(_impl->begin) + ".pvd"), "w");
}

Fields::~Fields()
{
  // The writer leaves a series of its own outputs behind.
  if (not _impl or not _impl->vtk)
    return;
  const bool ours = _impl->rank() == 0 and _impl->begin > 0;
  _impl->vtk.reset();
  std::error_code error;
  if (ours)
    std::filesystem::remove(_impl->folder / (stem(_impl->begin) + ".pvd"),
                            error);
}

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
  _impl->outputs.push_back({t, _impl->begin});
  complaint = broken(_impl->piece());
  agree(comm, complaint, elsewhere);
  if (_impl->begin == 0)
    _impl->vtk->flush();
  on_root(comm,
          [&]
          {
            if (_impl->begin > 0)
              write_atomically(_impl->file, pvd(_impl->outputs));
            else if (const auto why = broken(_impl->file); not why.empty())
              throw std::runtime_error(why);
          });
}

const std::vector<FieldOutput>& Fields::outputs() const
{
  return _impl->outputs;
}

const std::map<std::string, FieldInfo>& Fields::info() const
{
  return _impl->info;
}
} // namespace mmale::output
