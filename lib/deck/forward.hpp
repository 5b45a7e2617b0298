#pragma once
// Classes that many headers only refer to.

namespace Teuchos {
class ParameterEntry;
class ParameterList;
}  // namespace Teuchos

namespace tanktread::deck {
class Section;
}
