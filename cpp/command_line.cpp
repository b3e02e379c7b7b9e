// SPDX-License-Identifier: LGPL-3.0-or-later
#include "command_line.h"

#include <algorithm>
#include <iostream>

namespace mmale
{
Exit end_of(bool completed, bool checks_hold)
{
  if (not completed)
    return stopped;
  return checks_hold ? good : checks_fail;
}

Exit worst(const std::set<Exit>& ends)
{
  for (Exit end : {failure, stopped, checks_fail})
    if (ends.contains(end))
      return end;
  return good;
}

void print(std::span<const scene::Complaint> complaints)
{
  std::vector<std::string> lines;
  for (const scene::Complaint& complaint : complaints)
    if (const std::string line = to_string(complaint);
        std::ranges::find(lines, line) == lines.end())
      lines.push_back(line);
  for (const std::string& line : lines)
    std::cerr << line << "\n";
  std::cerr << "mmale: " << lines.size()
            << (lines.size() == 1 ? " complaint" : " complaints")
            << ", nothing was run\n";
}

std::filesystem::path results_folder(const Arguments& given,
                                     const std::string& usual)
{
  if (not given.results.empty())
    return given.results;
  const std::filesystem::path folder =
      std::filesystem::absolute(given.scene).parent_path().filename();
  const bool named_by_folder =
      given.scene.filename() == usual and not folder.empty();
  return "results" / (named_by_folder ? folder : given.scene.stem());
}
} // namespace mmale
