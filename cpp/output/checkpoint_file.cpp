// SPDX-License-Identifier: LGPL-3.0-or-later
#include "checkpoint_file.h"

#include "on_root.h"
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <hdf5.h>
#include <stdexcept>
#include <unistd.h>
#include <utility>

namespace mmale::output
{
namespace
{
/// HDF5 tells its errors through us only, while this lives.
class Quiet
{
public:
  Quiet()
  {
    H5Eget_auto2(H5E_DEFAULT, &_print, &_data);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, _print, _data); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

private:
  H5E_auto2_t _print = nullptr;
  void* _data = nullptr;
};

/// Anything of HDF5's that has to be closed.
class Handle
{
public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : _id(id), _close(close) {}
  ~Handle()
  {
    if (_id >= 0)
      _close(_id);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle(Handle&& other) noexcept
      : _id(std::exchange(other._id, -1)), _close(other._close)
  {
  }
  operator hid_t() const { return _id; }
  bool close() { return _close(std::exchange(_id, -1)) >= 0; }
  void abandon() { _id = -1; }

private:
  hid_t _id;
  Close _close;
};

/// The cause that HDF5 gives first: the system's words if it has them.
std::string cause()
{
  std::string out;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* error, void* to) -> herr_t
      {
        if (n == 0 and error->desc)
          *static_cast<std::string*>(to) = error->desc;
        return 0;
      },
      &out);
  const std::string mark = "error message = '";
  if (const auto at = out.find(mark); at != std::string::npos)
  {
    out.erase(0, at + mark.size());
    out.resize(std::min(out.size(), out.find('\'')));
  }
  return out.empty() ? "HDF5 gives no cause" : out;
}

/// Try the place, and whether the disk has room for all of it. HDF5 alone
/// would find out half way, when the ranks can no longer agree.
void make_room(const std::filesystem::path& part, std::int64_t bytes)
{
  const int fd =
      ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0)
    throw std::runtime_error(std::strerror(errno));
  int error = ::posix_fallocate(fd, 0, static_cast<off_t>(bytes));
  // what cannot reserve room may still have it
  if (error == EINVAL or error == EOPNOTSUPP)
    error = 0;
  ::close(fd);
  if (error != 0)
    throw std::runtime_error(std::strerror(error));
}

/// Bring a file or folder to the disk, where the file system can do that.
void sync(const std::filesystem::path& what, int flags)
{
  const int fd = ::open(what.c_str(), flags | O_CLOEXEC);
  const bool ok = fd >= 0 and (::fsync(fd) == 0 or errno == EINVAL);
  const int error = errno;
  if (fd >= 0)
    ::close(fd);
  if (not ok)
    throw std::runtime_error(std::strerror(error));
}

std::int64_t bytes(std::span<const Dataset> datasets)
{
  // headers, and the alignment of what lies behind them
  std::int64_t out = 65536;
  for (const Dataset& d : datasets)
    out += 8 * d.rows * d.width + 4096
           + static_cast<std::int64_t>(
               std::holds_alternative<std::string>(d.content)
                   ? std::get<std::string>(d.content).size()
                   : 0);
  return out;
}

Handle type_of(const Content& content, std::size_t text_size)
{
  if (std::holds_alternative<std::vector<double>>(content))
    return Handle(H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose);
  if (std::holds_alternative<std::vector<std::int64_t>>(content))
    return Handle(H5Tcopy(H5T_NATIVE_INT64), H5Tclose);
  Handle out(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(out, std::max<std::size_t>(1, text_size));
  H5Tset_cset(out, H5T_CSET_UTF8);
  H5Tset_strpad(out, H5T_STR_NULLPAD);
  return out;
}

/// @return false if this rank could not write its rows
bool write_one(hid_t file, MPI_Comm comm, const Dataset& d)
{
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const std::string* text = std::get_if<std::string>(&d.content);
  unsigned long size = text ? text->size() : 0;
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, comm);
  const Handle type = type_of(d.content, size);
  const hsize_t shape[2] = {static_cast<hsize_t>(d.rows),
                            static_cast<hsize_t>(d.width)};
  const int dims = text ? 0 : d.width == 1 ? 1 : 2;
  const Handle space(dims == 0 ? H5Screate(H5S_SCALAR)
                               : H5Screate_simple(dims, shape, nullptr),
                     H5Sclose);
  const Handle groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(groups, 1);
  const Handle as_is(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(as_is, false); // the same run, the same file
  H5Pset_fill_time(as_is, H5D_FILL_TIME_NEVER);
  const Handle set(
      H5Dcreate2(file, d.name.c_str(), type, space, groups, as_is, H5P_DEFAULT),
      H5Dclose);
  if (set < 0)
    return false;
  if (text)
  {
    // a text of no length has its one byte all the same
    std::string padded = *text;
    padded.resize(std::max<std::size_t>(1, size));
    return rank > 0
           or H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data())
                  >= 0;
  }
  const void* from = std::visit([](const auto& c) -> const void*
                                { return c.data(); }, d.content);
  const std::size_t numbers =
      std::visit([](const auto& c) { return c.size(); }, d.content);
  if (numbers == 0)
    return true;
  const hsize_t start[2] = {static_cast<hsize_t>(d.begin), 0};
  const hsize_t count[2] = {numbers / static_cast<hsize_t>(d.width),
                            static_cast<hsize_t>(d.width)};
  const Handle rows(H5Screate_simple(dims, count, nullptr), H5Sclose);
  return H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count,
                             nullptr)
             >= 0
         and H5Dwrite(set, type, rows, space, H5P_DEFAULT, from) >= 0;
}

/// Write the neighbour.
/// @return empty, or the cause on this rank or elsewhere
std::string write_part(MPI_Comm comm, const std::filesystem::path& part,
                       std::span<const Dataset> datasets)
{
  int size = 1;
  MPI_Comm_size(comm, &size);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (size > 1)
    H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL);
  else // nobody else writes it, and some file systems have no locks
    H5Pset_file_locking(access, false, true);
  Handle file(H5Fcreate(part.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access),
              H5Fclose);
  std::string out = file < 0 ? cause() : "";
  const auto failed = [&]
  {
    int any = out.empty() ? 0 : 1;
    MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, comm);
    if (any and out.empty())
      out = "another rank could not";
    // closing is collective, and would try to write again
    if (any and size > 1)
      file.abandon();
    return any != 0;
  };
  if (failed())
    return out;
  for (const Dataset& d : datasets)
  {
    if (not write_one(file, comm, d))
      out = cause();
    if (failed())
      return out;
  }
  // From here on a failure is of one rank alone: what HDF5 does within is
  // collective.
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 or not file.close())
    out = cause();
  return out;
}
} // namespace

void write_datasets(MPI_Comm comm, const std::filesystem::path& file,
                    std::span<const Dataset> datasets)
{
  std::filesystem::path part = file;
  part += ".part";
  const Quiet quiet;
  const auto fail = [&](const std::string& why)
  {
    std::error_code gone;
    std::filesystem::remove(part, gone);
    throw std::runtime_error("cannot write " + file.string() + ": " + why);
  };
  const auto root = [&](auto&& work)
  {
    try
    {
      on_root(comm, work);
    }
    catch (const std::runtime_error& error)
    {
      fail(error.what());
    }
  };
  root([&] { make_room(part, bytes(datasets)); });
  if (const std::string why = write_part(comm, part, datasets); not why.empty())
    fail(why);
  root(
      [&]
      {
        sync(part, O_RDWR);
        if (::rename(part.c_str(), file.c_str()) != 0)
          throw std::runtime_error(std::strerror(errno));
        const auto folder = file.parent_path();
        sync(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
      });
}

FileKind file_kind(const std::filesystem::path& file)
{
  const Quiet quiet;
  std::error_code error;
  if (not std::filesystem::exists(file, error))
    return FileKind::missing;
  if (H5Fis_accessible(file.c_str(), H5P_DEFAULT) <= 0)
    return FileKind::foreign;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);
  const Handle id(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  return id < 0 ? FileKind::damaged : FileKind::whole;
}

DatasetReader::DatasetReader(std::filesystem::path file)
    : _file(std::move(file))
{
  const Quiet quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);
  _id = H5Fopen(_file.c_str(), H5F_ACC_RDONLY, access);
  if (_id < 0)
    throw std::runtime_error("cannot read " + _file.string() + ": " + cause());
}

DatasetReader::~DatasetReader()
{
  const Quiet quiet;
  H5Fclose(_id);
}

bool DatasetReader::has(const std::string& name) const
{
  const Quiet quiet;
  // every group on the way has to be asked for by itself
  for (auto at = name.find('/'); at != std::string::npos;
       at = name.find('/', at + 1))
    if (H5Lexists(_id, name.substr(0, at).c_str(), H5P_DEFAULT) <= 0)
      return false;
  return H5Lexists(_id, name.c_str(), H5P_DEFAULT) > 0;
}

void DatasetReader::damaged(const std::string& name) const
{
  throw std::runtime_error(_file.string() + " is damaged: no whole '" + name
                           + "' in it");
}

std::array<std::int64_t, 2> DatasetReader::shape(const std::string& name) const
{
  const Quiet quiet;
  const Handle set(H5Dopen2(_id, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(set < 0 ? -1 : H5Dget_space(set), H5Sclose);
  const int dims = space < 0 ? -1 : H5Sget_simple_extent_ndims(space);
  hsize_t size[2] = {1, 1};
  if (dims < 0 or dims > 2
      or H5Sget_simple_extent_dims(space, size, nullptr) < 0)
    damaged(name);
  return {static_cast<std::int64_t>(size[0]),
          static_cast<std::int64_t>(size[1])};
}

void DatasetReader::read(const std::string& name, std::int64_t type,
                         std::int64_t begin, std::int64_t count, void* to) const
{
  const auto [rows, width] = shape(name);
  if (begin + count > rows)
    damaged(name);
  if (count == 0)
    return;
  const Quiet quiet;
  const Handle set(H5Dopen2(_id, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(set), H5Sclose);
  const int dims = H5Sget_simple_extent_ndims(space);
  const hsize_t start[2] = {static_cast<hsize_t>(begin), 0};
  const hsize_t size[2] = {static_cast<hsize_t>(count),
                           static_cast<hsize_t>(width)};
  const Handle memory(H5Screate_simple(std::max(1, dims), size, nullptr),
                      H5Sclose);
  if ((dims > 0
       and H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, size,
                               nullptr)
               < 0)
      or H5Dread(set, type, dims > 0 ? hid_t(memory) : H5S_ALL,
                 dims > 0 ? hid_t(space) : H5S_ALL, H5P_DEFAULT, to)
             < 0)
    damaged(name);
}

std::vector<double> DatasetReader::numbers(const std::string& name,
                                           std::int64_t begin,
                                           std::int64_t count) const
{
  std::vector<double> out(static_cast<std::size_t>(count * shape(name)[1]));
  read(name, H5T_NATIVE_DOUBLE, begin, count, out.data());
  return out;
}

std::vector<double> DatasetReader::numbers(const std::string& name) const
{
  return numbers(name, 0, shape(name)[0]);
}

std::vector<std::int64_t> DatasetReader::counts(const std::string& name) const
{
  const auto [rows, width] = shape(name);
  std::vector<std::int64_t> out(static_cast<std::size_t>(rows * width));
  read(name, H5T_NATIVE_INT64, 0, rows, out.data());
  return out;
}

std::string DatasetReader::text(const std::string& name) const
{
  const Quiet quiet;
  const Handle set(H5Dopen2(_id, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle type(set < 0 ? -1 : H5Dget_type(set), H5Tclose);
  if (type < 0 or H5Tget_class(type) != H5T_STRING
      or H5Tis_variable_str(type) != 0)
    damaged(name);
  std::string out(H5Tget_size(type), '\0');
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0)
    damaged(name);
  out.resize(std::min(out.size(), out.find('\0')));
  return out;
}
} // namespace mmale::output
