#pragma once
// Forward declarations of classes that many headers refer to.

namespace Teuchos {
class ParameterEntry;
class ParameterList;
}  // namespace Teuchos

namespace tanktread {
class Rejections;
}

namespace tanktread::deck {
class Section;
}
