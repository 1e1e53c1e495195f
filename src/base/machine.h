// What the log says about the machine that measured.
#pragma once

#include <string>

namespace tenebra::base {

/// The processor as the system names it, and the number of its logical cores open to this process:
/// "Intel(R) Xeon(R) ..., 8 cores". "unknown processor" where the system does not say.
std::string machine_description();

/// Value of the environment variable `name`, or `otherwise` where it is not set.
std::string environment_or(const char* name, const std::string& otherwise);

}  // namespace tenebra::base
