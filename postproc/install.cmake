# Installs the Python package tanktread with its commands. Under /usr and /usr/local it goes where Debian's Python finds it, so that
# `import tanktread` works from anywhere; under another prefix the commands find it, and scripts set PYTHONPATH.
install(CODE [[
  set(tanktread_python lib/python3/dist-packages)
  if(CMAKE_INSTALL_PREFIX MATCHES "/usr/local/?$")
    execute_process(COMMAND /usr/bin/python3 -c "import sys; print('lib/python%d.%d/dist-packages' % sys.version_info[:2])"
      OUTPUT_VARIABLE tanktread_python OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  endif()]])
install(DIRECTORY ${CMAKE_CURRENT_LIST_DIR}/tanktread DESTINATION "\${tanktread_python}" PATTERN __pycache__ EXCLUDE)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/open_in_paraview.py DESTINATION ${CMAKE_INSTALL_DATADIR}/tanktread)
foreach(command figure sweep fit outline phases critical report read surface)
  install(PROGRAMS ${CMAKE_CURRENT_LIST_DIR}/tanktread-figure DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME tanktread-${command})
endforeach()
