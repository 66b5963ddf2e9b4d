/* SPDX-License-Identifier: MIT */
/* Contacts that are held: one more flag of hsp_contact.flags (see shape.h). */
#ifndef HAPTICD_HELD_H
#define HAPTICD_HELD_H
#define HSP_OUT_HELD (1u << 4) /* the foot of a held contact: another point of the model is nearer, or may be */
#endif
