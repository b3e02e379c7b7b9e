// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/complaint.h"
#include <algorithm>

namespace
{
/// Edits between two words: optimal string alignment, three rows of the
/// dynamic programme.
std::size_t edits(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1),
      row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const std::size_t replace = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + replace});
      if (i > 1 and j > 1 and a[i - 1] == b[j - 2] and a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}
} // namespace

namespace mmale::scene
{
std::string to_string(const Complaint& complaint)
{
  std::string text = complaint.place.file;
  if (complaint.place.line > 0)
    text += ":" + std::to_string(complaint.place.line);
  for (const std::string& part : {complaint.key, complaint.what})
    if (not part.empty())
      text += (text.empty() ? "" : ": ") + part;
  return text;
}

std::string nearest(std::string_view name, std::span<const std::string> known)
{
  std::string best;
  double least = 0.5;
  for (const std::string& word : known)
  {
    const double changed = edits(name, word);
    const double letters = std::max(name.size(), word.size());
    // One wrong letter of two, as in a law's name, is still a slip.
    const double share = std::min(changed / letters, changed > 1 ? 1 : 0.49);
    if (share < least)
    {
      least = share;
      best = word;
    }
  }
  return best;
}

std::string suggestion(std::string_view name,
                       std::span<const std::string> known)
{
  if (known.empty())
    return "none is known";
  const std::string near = nearest(name, known);
  return near.empty()
             ? "known: " + join(known)
             : "did you mean '" + near + "'? (known: " + join(known) + ")";
}

std::string missing(const std::string& sentence, const std::string& unit,
                    const std::string& allowed)
{
  std::string text = "missing: " + sentence;
  if (text.ends_with('.'))
    text.pop_back();
  if (not unit.empty() and unit != "-")
    text += " [" + unit + "]";
  return allowed.empty() ? text : text + ", " + allowed;
}

std::string join(std::span<const std::string> words)
{
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  return text;
}
} // namespace mmale::scene
