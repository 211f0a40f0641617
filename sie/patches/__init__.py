"""Contact in several patches, on the line and per period."""
