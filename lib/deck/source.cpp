#include "deck/source.hpp"

#include <filesystem>
#include <regex>

#include <Teuchos_ParameterList.hpp>
#include <Teuchos_XMLParameterListCoreHelpers.hpp>

#include "base/errors.hpp"
#include "base/text_file.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

/// Returns the nesting depth of the XML elements. The depth must be limited, because the XML reader of Teuchos calls itself once per level.
int levels_of_xml(const std::string& text) {
  int level = 0, most = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos && at + 1 < text.size(); at = text.find('<', at + 1)) {
    if (text.compare(at, 4, "<!--") == 0) {
      at = std::min(text.find("-->", at), text.size() - 1);
    } else if (text[at + 1] == '/') {
      --level;
    } else if (text[at + 1] != '?' && text[at + 1] != '!') {
      most = std::max(most, ++level);
      const std::size_t end = text.find('>', at);
      if (end != std::string::npos && text[end - 1] == '/') --level;
    }
  }
  return most;
}

}  // namespace

std::shared_ptr<Teuchos::ParameterList> root_list(const Teuchos::ParameterList& whole, const std::string& origin) {
  if (whole.numParams() == 0) throw UserError(origin + " is empty; a deck has one section named `" + root_name + "`.");
  for (const auto& item : whole) {
    if (item.first == root_name && !item.second.isList()) throw UserError(origin + ": `" + root_name + "` must be a section with keys.");
    if (item.first != root_name)
      throw UserError(origin + ": the outermost section must be `" + root_name + "`, and the only one, but there is `" +
                      shortened(item.first, 60) + "`.");
  }
  return std::make_shared<Teuchos::ParameterList>(whole.sublist(root_name));
}

std::shared_ptr<Teuchos::ParameterList> xml_list(const std::string& text, const std::string& origin) {
  if (levels_of_xml(text) > 100) throw UserError(origin + ": its elements are nested more than 100 deep.");
  std::smatch name;  // name of the outermost list, which the XML reader of Teuchos does not return
  std::regex_search(text, name, std::regex("<ParameterList\\s+name=\"([^\"]{1,60})\""));
  Teuchos::ParameterList whole;
  try {
    const auto list = Teuchos::getParametersFromXmlString(text);
    whole.sublist(name.empty() ? "something else" : name[1].str()) = *list;
  } catch (const std::exception&) {
    throw UserError(origin + " is not XML in the format of parameter lists of Teuchos, a package of Trilinos.");
  }
  return root_list(whole, origin);
}

std::shared_ptr<Teuchos::ParameterList> file_list(const std::string& file) {
  if (std::error_code error; file.find('=') != file.npos && !std::filesystem::exists(file, error))
    throw UserError("The deck " + shortened(file, 80) + " does not exist. If it is a setting, it needs a --set of its own.");
  const std::string text = text_of_file(file, "The deck " + shortened(file, 80), 1'000'000);
  return file.ends_with(".xml") ? xml_list(text, file) : yaml_list(text, file);
}

}  // namespace tanktread::deck
