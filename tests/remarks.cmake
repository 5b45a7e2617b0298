# remarks_of(FILE): reads the properties of a test from comment lines among the first twenty lines of a deck or script:
#   # base: inputs/shear_neo_hookean.yaml     # ranks: 2     # label: long
# Sets remark_base, remark_ranks (default 1) and remark_label. If the file changes, the next build configures again.
function(remarks_of file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(STRINGS ${file} lines LIMIT_COUNT 20 REGEX "^# *(base|ranks|label):")
  set(base)
  set(ranks 1)
  set(label)
  foreach(line ${lines})
    if(line MATCHES "^# *(base|ranks|label): *([^ ]+) *$")
      set(${CMAKE_MATCH_1} ${CMAKE_MATCH_2})
    endif()
  endforeach()
  foreach(key base ranks label)
    set(remark_${key} "${${key}}" PARENT_SCOPE)
  endforeach()
endfunction()
