# Writes the manual page OUTPUT from the help text of PROGRAM.
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\\" "\\\\" help "${help}")
string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" help "${help}")
string(REPLACE "-" "\\-" help "${help}")
file(WRITE ${OUTPUT} ".TH TANKTREAD 1 \"\" \"tanktread ${VERSION}\"
.SH NAME
tanktread \\- deformable capsules and drops in viscous flow
.SH DESCRIPTION
.nf
${help}
.fi
.SH SEE ALSO
Every key of a deck: tanktread \\-\\-reference. Every series of the results: tanktread \\-\\-reference\\-series.
Studies: tanktread\\-sweep, tanktread\\-fit, tanktread\\-outline, tanktread\\-report, each with \\-\\-help.
")
