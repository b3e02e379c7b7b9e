// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/document.h"
#include "scene/filler.h"
#include <algorithm>
#include <functional>
#include <span>
#include <tuple>

/// From a document with changes to a table and every complaint about it.
namespace mmale::scene
{
/// Place of the longest part of a key that was written.
inline Place place_of(const Record& record, std::string key, const Place& root)
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
inline bool has_failed(const Record& record, std::string key)
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

/// Fill a table from a document, then check it.
///
/// @param document  as parsed; of a text that is no TOML nothing else is said
/// @param overrides changes, in order; the last on a key holds
/// @param table     is filled
/// @param check     what is wrong with it: complaints without places
/// @param prepare   changes the document once the overrides are in
/// @return in the order of the file's lines
template <Table T, class Check>
std::vector<Complaint>
take(Document document, std::span<const Override> overrides, T& table,
     Check check, const std::function<void(Document&)>& prepare = {})
{
  if (not document.complaints.empty())
    return std::move(document.complaints);
  for (const Override& change : overrides)
    put(document, change);
  if (prepare)
    prepare(document);
  Record record;
  record.complaints = std::move(document.complaints);
  Filler filler(document.root, "", record);
  keys(filler, table);
  filler.finish();
  for (Complaint& complaint : check(table))
    if (not has_failed(record, complaint.key))
    {
      if (complaint.place.file.empty())
        complaint.place = place_of(record, complaint.key, document.root.place);
      record.complaints.push_back(std::move(complaint));
    }
  const std::string& file = document.root.place.file;
  std::ranges::stable_sort(record.complaints, {},
                           [&](const Complaint& c)
                           {
                             // what the own text is to blame for first
                             return std::tuple(c.place.file != file,
                                               c.place.file, c.place.line,
                                               c.key);
                           });
  return std::move(record.complaints);
}
} // namespace mmale::scene
