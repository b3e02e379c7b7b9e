// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "command_line.h"

namespace mmale::element
{
/// `mmale element`: a test or a sweep of tests, on one process.
Exit element_verb(const Arguments& given);
} // namespace mmale::element
