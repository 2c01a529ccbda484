/* Copyright (c) 2026, the gpo-inspector authors
   SPDX-License-Identifier: BSD-3-Clause
   Files embedded in the program, so that it runs from anywhere. */
#define EMBED(name, file) \
  .balign 16; .globl name; .hidden name; name: .incbin file; \
  .globl name##_end; .hidden name##_end; name##_end: .byte 0

  .section .rodata
EMBED(gpo_font_regular, GPO_FONT_REGULAR)
EMBED(gpo_font_bold, GPO_FONT_BOLD)
EMBED(gpo_robot, GPO_ROBOT)
EMBED(gpo_glossary, GPO_GLOSSARY)
EMBED(gpo_manual, GPO_MANUAL)
EMBED(gpo_report_css, GPO_REPORT_CSS)
EMBED(gpo_report_js, GPO_REPORT_JS)

  .section .note.GNU-stack, "", %progbits
