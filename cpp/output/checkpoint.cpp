// SPDX-License-Identifier: LGPL-3.0-or-later
#include "checkpoint.h"

#include <sstream>
#include <stdexcept>

namespace mmale::output
{
void CheckpointHeader::keep(Archive& archive)
{
  archive("format", format);
  archive("version", version);
  archive("scene", scene);
  archive("run/stage", standing.stage);
  archive("time", time);
  archive("completed", completed);
  archive("checks_hold", checks_hold);
}

FoundCheckpoint find_checkpoint(const std::filesystem::path& folder)
{
  FoundCheckpoint out;
  const auto file = folder / checkpoint_name;
  const auto trouble = [&](const std::string& words)
  {
    out.trouble = file.string() + ": " + words;
    return out;
  };
  const FileKind kind = file_kind(file);
  out.there = kind != FileKind::missing;
  if (kind == FileKind::foreign)
    return trouble("is no checkpoint");
  if (kind == FileKind::damaged)
    return trouble("is damaged, its end is missing");
  if (not out.there)
    return out;
  try
  {
    const DatasetReader reader(file);
    CheckpointHeader& h = out.header;
    if (not reader.has("format") or not reader.has("contents"))
      return trouble("is no checkpoint");
    h.format = reader.counts("format").at(0);
    if (h.format != checkpoint_format)
      return trouble("has format " + std::to_string(h.format)
                     + ", this program goes on with "
                     + std::to_string(checkpoint_format) + " only");
    h.version = reader.text("version");
    h.scene = reader.text("scene");
    h.standing.stage = static_cast<int>(reader.counts("run/stage").at(0));
    h.standing.time = reader.numbers("run/time_in_stage").at(0);
    h.time = reader.numbers("time").at(0);
    h.completed = static_cast<int>(reader.counts("completed").at(0));
    h.checks_hold = static_cast<int>(reader.counts("checks_hold").at(0));
    const auto names = from_lines(reader.text("curves/names"));
    const auto rows = reader.shape("curves/rows")[0];
    const auto last = reader.numbers("curves/rows", rows - 1, 1);
    for (std::size_t i = 0; i < names.size(); ++i)
      out.last[names[i]] = last.at(i);
  }
  catch (const std::exception& error)
  {
    out.trouble = error.what();
  }
  return out;
}

std::string lines(std::span<const std::string> names)
{
  std::string out;
  for (const std::string& name : names)
    out += name + "\n";
  return out;
}

std::vector<std::string> from_lines(const std::string& text)
{
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    out.push_back(line);
  return out;
}
} // namespace mmale::output
