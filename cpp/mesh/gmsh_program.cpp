// SPDX-License-Identifier: LGPL-3.0-or-later
#include "gmsh_program.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <format>
#include <fstream>
#include <spawn.h>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace mmale::mesh
{
namespace
{
/// The environment without what tells a child that it is a rank of our MPI:
/// gmsh, itself linked to MPI, would take part in our run.
std::vector<std::string> environment()
{
  static constexpr std::array<std::string_view, 5> ranks = {
      "OMPI_", "PMIX_", "PMI_", "PRTE_", "OPAL_"};
  std::vector<std::string> out;
  for (char** entry = environ; *entry; ++entry)
    if (std::ranges::none_of(
            ranks, [&](std::string_view prefix)
            { return std::string_view(*entry).starts_with(prefix); }))
      out.emplace_back(*entry);
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& words)
{
  std::vector<char*> out;
  for (std::string& word : words)
    out.push_back(word.data());
  out.push_back(nullptr);
  return out;
}

/// Start a program and wait for it; what it says goes to `log`.
/// @param[out] status as wait gives it
/// @return an error number when it could not be started
int call(std::vector<std::string> words, const std::string& log, int& status)
{
  std::vector<std::string> variables = environment();
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY,
                                   0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, words[0].c_str(), &files, nullptr,
                   pointers(words).data(), pointers(variables).data());
  posix_spawn_file_actions_destroy(&files);
  if (error != 0)
    return error;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      return errno;
  return 0;
}

/// The last lines that it said, errors before anything else.
/// @param[out] erred was any line an error?
std::string last_lines(const std::string& log, bool& erred)
{
  constexpr std::size_t most = 6;
  std::vector<std::string> all, errors;
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);)
  {
    if (line.starts_with("Error"))
      errors.push_back(line);
    if (not line.empty())
      all.push_back(line);
  }
  erred = not errors.empty();
  const auto& told = erred ? errors : all;
  std::string text;
  for (std::size_t i = told.size() - std::min(most, told.size());
       i < told.size(); ++i)
    text += "\n    " + told[i];
  return text;
}
} // namespace

std::string run_gmsh(const std::filesystem::path& geo, double refine,
                     const std::filesystem::path& folder)
{
  const std::string mesh = folder / "mesh.msh", log = folder / "log";
  std::vector<std::string> words = {"gmsh",
                                    std::filesystem::absolute(geo).string(),
                                    "-2",
                                    "-format",
                                    "msh41",
                                    "-o",
                                    mesh,
                                    "-clscale",
                                    std::format("{}", 1 / refine),
                                    "-v",
                                    "3"};
  // Without it, curves with a given number of edges keep it.
  if (refine != 1)
    words.insert(words.end(), {"-setnumber", "Mesh.FlexibleTransfinite", "1"});
  int status = 0;
  if (const int error = call(words, log, status); error == ENOENT)
    return "the program gmsh, which makes a mesh of it, is not there (Debian: "
           "apt install gmsh); a .msh needs no gmsh";
  else if (error != 0)
    return std::string("gmsh cannot be started: ") + std::strerror(error);
  bool erred = false;
  const std::string told = last_lines(log, erred);
  if (WIFSIGNALED(status))
    return std::format("gmsh was ended by signal {}:{}", WTERMSIG(status),
                       told);
  if (WEXITSTATUS(status) != 0 or erred)
    return "gmsh fails:" + told;
  if (not std::filesystem::exists(mesh))
    return "gmsh wrote no mesh:" + told;
  return "";
}
} // namespace mmale::mesh
