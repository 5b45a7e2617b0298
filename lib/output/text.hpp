#pragma once
// Numbers and words as YAML and JSON read them.

#include <string>
#include <string_view>

namespace tanktread::output {

/// The shortest decimal form that reads back as the same double, with a point in it ("1.0", "2.5e-06"; YAML 1.1 takes "2.5e-6" and
/// "1e-06" for words); ".nan", ".inf", "-.inf" as YAML spells them.
std::string number(double value);

/// In double quotes, with the escapes that JSON and YAML share. UTF-8 passes through.
std::string in_quotes(std::string_view text);

/// "0.8 s", "42 s", "3 min 08 s", "2 h 05 min".
std::string duration(double seconds);

}  // namespace tanktread::output
