# Run at every build: writes OUTPUT from app/provenance.cpp.in, and touches it only when the commit has changed.
execute_process(
  COMMAND git -c safe.directory=* describe --always --dirty --abbrev=12 --exclude=*
  WORKING_DIRECTORY ${SOURCE}
  OUTPUT_VARIABLE COMMIT RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(failed)
  set(COMMIT unknown)
endif()
configure_file(${SOURCE}/provenance.cpp.in ${OUTPUT} @ONLY)
