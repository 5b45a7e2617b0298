#include "deck/source.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include <Teuchos_ParameterList.hpp>
#include <Teuchos_XMLParameterListCoreHelpers.hpp>
#include <Teuchos_YamlParameterListCoreHelpers.hpp>

#include "base/errors.hpp"
#include "deck/words.hpp"
#include "deck/yaml_lines.hpp"

namespace tanktread::deck {

namespace {

/// A copy with every name and text as the user wrote it.
Teuchos::ParameterList decoded_list(const Teuchos::ParameterList& list) {
  Teuchos::ParameterList out(list.name());
  for (const auto& item : list) {
    const std::string name = decoded(item.first);
    const Teuchos::ParameterEntry& entry = item.second;
    if (entry.isList()) {
      out.sublist(name) = decoded_list(Teuchos::getValue<Teuchos::ParameterList>(entry));
    } else if (entry.isType<std::string>()) {
      out.set(name, decoded(Teuchos::getValue<std::string>(entry)));
    } else if (entry.isType<Teuchos::Array<std::string>>()) {
      auto texts = Teuchos::getValue<Teuchos::Array<std::string>>(entry);
      for (std::string& text : texts) text = decoded(text);
      out.set(name, texts);
    } else {
      out.setEntry(name, entry);
    }
  }
  return out;
}

/// The one thing to know from the several lines that Teuchos throws: where it stopped, and the line that stands there.
std::string reduced(const std::string& error, const std::vector<std::string>& lines) {
  std::smatch match;
  if (std::regex_search(error, match, std::regex("Parameter \"([^\"]*)\" already exists")))
    return ": " + match[1].str() + " is given twice";
  if (!std::regex_search(error, match, std::regex("line (\\d+)")) || lines.empty())
    return std::string(" is not YAML with one list named `") + root_name + "`";
  std::size_t number = std::stoul(match[1].str());
  if (error.find("Got: NEWLINE") != std::string::npos && number > 1) --number;  // it stopped at the end of the line before
  number = std::min(number, lines.size());
  while (number > 1 && lines[number - 1].empty()) --number;
  std::string line = decoded(lines[number - 1]);
  line.erase(0, line.find_first_not_of(" \t"));
  if (line.size() > 80) line = line.substr(0, 77) + "...";
  return ", line " + std::to_string(number) + ": this is not YAML that can be read: `" + line + "`";
}

/// Without the blanks around it.
std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? std::string() : text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

void check_root(const std::vector<std::string>& keys, const std::string& origin) {
  if (keys.empty()) throw UserError(origin + " is empty; a deck holds one list named `" + root_name + "`.");
  if (keys.size() == 1 && keys.front() == root_name) return;
  const std::string& other = keys.front() == root_name ? keys.back() : keys.front();
  const std::string found = other.empty() || other.size() > 60 ? "something else" : "`" + other + "`";
  throw UserError(origin + ": the outermost list must be `" + root_name + "`, and the only one, but there is " + found + ".");
}

std::shared_ptr<Teuchos::ParameterList> parsed(const std::vector<std::string>& lines, const std::string& origin) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  try {
    return std::make_shared<Teuchos::ParameterList>(decoded_list(*Teuchos::getParametersFromYamlString(text)));
  } catch (const std::exception& error) {
    throw UserError(origin + reduced(error.what(), lines) + ".");
  }
}

}  // namespace

std::string file_text(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw UserError("The deck " + file + " does not exist.");
  if (fs::is_directory(status)) throw UserError(file + " is a directory, not a deck.");
  std::ifstream stream(file, std::ios::binary);
  constexpr std::size_t most = 10'000'000;
  std::string text, block(1 << 14, '\0');
  while (stream && text.size() <= most) {  // no more is read, of a device or a pipe neither
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block, 0, static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream && !stream.eof()) throw UserError("The deck " + file + " cannot be read.");
  if (text.size() > most) throw UserError(file + " is larger than 10 MB, so no deck.");
  const std::string byte_order_mark = "\xEF\xBB\xBF";  // which some editors begin UTF-8 with
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  return text;
}

std::shared_ptr<Teuchos::ParameterList> yaml_list(const std::string& text, const std::string& origin) {
  const std::vector<std::string> lines = clean_lines(text, origin);
  const std::vector<std::string> keys = outermost_keys(lines);
  const bool any_key = std::any_of(keys.begin(), keys.end(), [](const std::string& key) { return !key.empty(); });
  if (any_key || keys.empty()) check_root(keys, origin);  // otherwise let the reader say where it stops
  return parsed(lines, origin);
}

std::shared_ptr<Teuchos::ParameterList> xml_list(const std::string& text, const std::string& origin) {
  std::smatch root;  // the reader forgets the name of the outermost list
  std::regex_search(text, root, std::regex("<ParameterList\\s+name=\"([^\"]*)\""));
  try {
    auto list = std::make_shared<Teuchos::ParameterList>(*Teuchos::getParametersFromXmlString(text));
    check_root({root.empty() ? std::string() : root[1].str()}, origin);
    return list;
  } catch (const UserError&) {
    throw;
  } catch (const std::exception&) {
    throw UserError(origin + " is not XML of the kind that Teuchos reads.");
  }
}

std::shared_ptr<Teuchos::ParameterList> setting_list(const std::string& setting) {
  const std::string origin = "--set '" + setting + "'";
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == setting.size() || setting.find('\n') != std::string::npos)
    throw UserError(origin + " must be of the form Section/key=value.");
  std::istringstream path(setting.substr(0, equals));
  std::vector<std::string> keys;
  for (std::string key; std::getline(path, key, '/');) keys.push_back(trimmed(key));
  if (keys.front() == root_name) keys.erase(keys.begin());
  if (keys.size() < 2 || std::any_of(keys.begin(), keys.end(), [](const std::string& key) { return key.empty(); }))
    throw UserError(origin + " must be of the form Section/key=value.");
  std::string text = std::string(root_name) + ":\n", indent;
  for (std::size_t i = 0; i < keys.size(); ++i) text += (indent += "  ") + in_quotes(keys[i]) + ":" + (i + 1 < keys.size() ? "\n" : " ");
  text += setting.substr(equals + 1);
  const std::vector<std::string> lines = clean_lines(text, origin);
  try {
    return parsed(lines, origin);
  } catch (const UserError&) {
    throw UserError(origin + ": the value is not YAML that can be read.");
  }
}

}  // namespace tanktread::deck
