// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/reader.h"
#include "scene/check.h"
#include "scene/filler.h"
#include "scene/schema.h"
#include <algorithm>
#include <fstream>
#include <sstream>
#include <tuple>

namespace mmale::scene
{
namespace
{
/// Place of the longest part of a key that was written.
Place place_of(const Record& record, std::string key, const Place& root)
{
  for (;;)
  {
    if (const auto at = record.places.find(key); at != record.places.end())
      return at->second;
    const auto dot = key.rfind('.');
    if (dot == std::string::npos)
      return root;
    key.resize(dot);
  }
}

/// True when the key, or a table that holds it, was not read: then what the
/// checks say about it is no news.
bool has_failed(const Record& record, std::string key)
{
  for (;;)
  {
    if (record.failed.contains(key))
      return true;
    const auto dot = key.rfind('.');
    if (dot == std::string::npos)
      return false;
    key.resize(dot);
  }
}
} // namespace

FileText load(const std::filesystem::path& path)
{
  const auto complaint = [&](const std::string& what)
  { return FileText{"", {{"", what, {path.string(), 0}}}}; };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (not std::filesystem::exists(status))
    return complaint("no such file");
  if (std::filesystem::is_directory(status))
    return complaint(std::filesystem::exists(path / "scene.toml", error)
                         ? "is a folder; the scene is "
                               + (path / "scene.toml").string()
                         : "is a folder, not a scene");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (not file or not(text << file.rdbuf()))
    return complaint(std::filesystem::file_size(path, error) == 0
                         ? "is empty"
                         : "cannot be read");
  return {text.str(), {}};
}

Reading read(std::string_view text, const std::string& file,
             std::span<const Override> overrides, const Libraries& libraries,
             const OutlineReader& read_mesh, const DomainReader& read_domain)
{
  Reading reading;
  Document document = parse(text, file);
  // Of a text that is no TOML nothing else can be said.
  if (not document.complaints.empty())
    return {{}, std::move(document.complaints)};
  for (const Override& change : overrides)
    put(document, change);

  Record record;
  record.complaints = std::move(document.complaints);
  Filler filler(document.root, "", record);
  keys(filler, reading.scene);
  filler.finish();
  const std::string folder = std::filesystem::path(file).parent_path();
  reading.scene.mesh.folder = folder;
  for (auto& [name, domain] : reading.scene.domain)
    domain.folder = folder;

  for (Complaint& complaint :
       check(reading.scene, libraries, read_mesh, read_domain))
    if (not has_failed(record, complaint.key))
    {
      if (complaint.place.file.empty())
        complaint.place = place_of(record, complaint.key, document.root.place);
      record.complaints.push_back(std::move(complaint));
    }
  std::ranges::stable_sort(record.complaints, {},
                           [&](const Complaint& c)
                           {
                             // what the scene's own text is to blame for first
                             return std::tuple(c.place.file != file,
                                               c.place.file, c.place.line,
                                               c.key);
                           });
  reading.complaints = std::move(record.complaints);
  return reading;
}
} // namespace mmale::scene
